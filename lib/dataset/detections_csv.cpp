// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/detections_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include "base/error.h"
#include "dataset/text_file.h"

namespace soslam {
namespace {

using Columns = std::vector<const char*>;

const Columns kLabelledColumns = {"frame", "label", "score", "x1", "y1", "x2", "y2"};
const Columns kColumns = {"frame", "object_id", "label", "score", "x1", "y1", "x2", "y2"};

// Where each column stands in a row.
std::vector<size_t> ColumnPositions(const std::vector<std::string_view>& header_fields,
                                    const Columns& columns, const std::string& place) {
  std::vector<size_t> positions;
  for (const char* column : columns) {
    const auto found = std::find(header_fields.begin(), header_fields.end(), column);
    if (found == header_fields.end() ||
        std::find(found + 1, header_fields.end(), column) != header_fields.end()) {
      throw InputError(fmt::format("{}: column '{}' is {}; expected each of {} once", place, column,
                                   found == header_fields.end() ? "missing" : "twice",
                                   fmt::join(columns, ",")));
    }
    positions.push_back(static_cast<size_t>(found - header_fields.begin()));
  }
  return positions;
}

// The fields of one row by the names of their columns.
class Row {
 public:
  Row(const TextLine& line, const Columns& columns, const std::vector<size_t>& positions,
      size_t header_size)
      : place_(line.place),
        fields_(SplitFields(line.text)),
        columns_(columns),
        positions_(positions) {
    if (fields_.size() != header_size) {
      throw InputError(fmt::format("{}: has {} fields; expected {}, as the header has", place_,
                                   fields_.size(), header_size));
    }
  }

  const std::string& place() const { return place_; }
  int Integer(const char* column) const { return ParseInteger(Field(column), place_, column); }
  double Real(const char* column) const { return ParseReal(Field(column), place_, column); }
  std::string Label() const {
    const std::string_view label = Field("label");
    if (label.empty()) throw InputError(place_ + ": label is empty; expected a category");
    return std::string(label);
  }
  soslam::Box Box() const { return {Real("x1"), Real("y1"), Real("x2"), Real("y2")}; }

 private:
  std::string_view Field(std::string_view column) const {
    const auto found = std::find(columns_.begin(), columns_.end(), column);
    return fields_[positions_[static_cast<size_t>(found - columns_.begin())]];
  }

  const std::string& place_;
  std::vector<std::string_view> fields_;
  const Columns& columns_;
  const std::vector<size_t>& positions_;
};

// Parses each line below the header of a table that has these columns.
template <typename Item>
std::vector<Item> ReadTable(const std::filesystem::path& path, const Columns& columns,
                            Item (*parse)(const Row&)) {
  const std::vector<TextLine> lines = ReadTextLines(path);
  if (lines.empty()) {
    throw InputError(
        fmt::format("{}: is empty; expected a header {}", path.string(), fmt::join(columns, ",")));
  }
  const auto header_fields = SplitFields(lines[0].text);
  const auto positions = ColumnPositions(header_fields, columns, lines[0].place);
  std::vector<Item> items;
  for (size_t i = 1; i < lines.size(); ++i) {
    items.push_back(parse(Row(lines[i], columns, positions, header_fields.size())));
  }
  return items;
}

DetectionRow ParseDetection(const Row& row) {
  return {row.place(), row.Integer("frame"), row.Integer("object_id"),
          row.Label(), row.Real("score"),    row.Box()};
}

LabelledBox ParseLabelledBox(const Row& row) {
  return {row.place(), row.Integer("frame"), row.Label(), row.Real("score"), row.Box()};
}

}  // namespace

bool HasObjectIds(const std::filesystem::path& path) {
  const std::vector<TextLine> lines = ReadTextLines(path);
  if (lines.empty()) return false;
  const auto columns = SplitFields(lines[0].text);
  return std::find(columns.begin(), columns.end(), "object_id") != columns.end();
}

std::vector<DetectionRow> ReadDetections(const std::filesystem::path& path) {
  return ReadTable(path, kColumns, &ParseDetection);
}

std::vector<LabelledBox> ReadLabelledBoxes(const std::filesystem::path& path) {
  return ReadTable(path, kLabelledColumns, &ParseLabelledBox);
}

std::string LabelledBoxesText(const std::vector<LabelledBox>& boxes) {
  std::string text = fmt::format("{}\n", fmt::join(kLabelledColumns, ","));
  for (const LabelledBox& row : boxes) {
    text += fmt::format("{},{},{:.4f},{:.2f},{:.2f},{:.2f},{:.2f}\n", std::get<int>(row.frame),
                        row.label, row.score, row.box.x_min, row.box.y_min, row.box.x_max,
                        row.box.y_max);
  }
  return text;
}

}  // namespace soslam

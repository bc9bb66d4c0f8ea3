// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/detections_csv.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <optional>
#include <string_view>
#include <variant>

#include "base/error.h"
#include "base/table.h"
#include "dataset/csv_line.h"
#include "dataset/text_file.h"

namespace soslam {
namespace {

constexpr std::array kColumns = {"frame", "label", "score", "x1", "y1", "x2", "y2"};
constexpr const char* kIdColumn = "object_id";

// Normalised column name: lower case, underscores instead of blanks.
std::string ColumnName(std::string field) {
  for (char& c : field) {
    c = c == ' ' ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return field;
}

// Table format given by the first line.
struct Header {
  char separator;
  size_t size;
  std::map<std::string, size_t> positions;  // column name -> index, for the columns that are read
};

Header ParseHeader(const TextLine& line) {
  Header header{SeparatorOf(line.text), 0, {}};
  const auto fields = SplitCsvLine(line.text, header.separator, line.place);
  header.size = fields.size();
  const auto refuse = [&](const std::string& column, const char* how_often) {
    throw InputError(fmt::format("{}: column '{}' is {}; expected each of {} once", line.place,
                                 column, how_often, fmt::join(kColumns, ",")));
  };
  for (size_t i = 0; i < fields.size(); ++i) {
    const std::string name = ColumnName(fields[i]);
    if (name != kIdColumn && std::ranges::find(kColumns, name) == kColumns.end()) continue;
    if (!header.positions.emplace(name, i).second) refuse(name, "twice");
  }
  for (const char* column : kColumns) {
    if (!header.positions.contains(column)) refuse(column, "missing");
  }
  return header;
}

// Fields of one row, accessed by column name.
class Row {
 public:
  Row(const TextLine& line, const Header& header)
      : place_(line.place),
        fields_(SplitCsvLine(line.text, header.separator, line.place)),
        header_(header) {
    if (fields_.size() == header.size) return;
    throw InputError(fmt::format("{}: has {} fields; expected {}, as the header has", place_,
                                 fields_.size(), header.size));
  }

  LabelledBox Parse() const {
    LabelledBox box{place_,
                    ParseInteger(Field("frame"), place_, "frame"),
                    Field("label"),
                    Real("score"),
                    {Real("x1"), Real("y1"), Real("x2"), Real("y2")}};
    if (box.label.empty()) throw InputError(place_ + ": label is empty; expected a category");
    if (header_.positions.contains(kIdColumn)) box.object_id = ObjectId();
    return box;
  }

 private:
  const std::string& Field(const char* column) const {
    return fields_[header_.positions.at(column)];
  }
  // Some programs write a column with gaps as real numbers: 7 is "7.0".
  std::optional<int> ObjectId() const {
    std::string_view text = Field(kIdColumn);
    if (text.empty()) return std::nullopt;
    if (text.ends_with(".0")) text.remove_suffix(2);
    return ParseInteger(text, place_, kIdColumn);
  }
  double Real(const char* column) const { return ParseReal(Field(column), place_, column); }

  const std::string& place_;
  std::vector<std::string> fields_;
  const Header& header_;
};

}  // namespace

std::vector<LabelledBox> ReadDetectionsCsv(const std::filesystem::path& path) {
  const std::vector<TextLine> lines = ReadTableLines(path);
  if (lines.empty()) {
    throw InputError(
        fmt::format("{}: is empty; expected a header {}", path.string(), fmt::join(kColumns, ",")));
  }
  const Header header = ParseHeader(lines[0]);
  std::vector<LabelledBox> boxes;
  for (size_t i = 1; i < lines.size(); ++i) boxes.push_back(Row(lines[i], header).Parse());
  return boxes;
}

std::string LabelledBoxesText(const std::vector<LabelledBox>& boxes) {
  std::string text = fmt::format("{}\n", fmt::join(kColumns, ","));
  for (const LabelledBox& row : boxes) {
    text += fmt::format("{},{},{:.4f},{:.2f},{:.2f},{:.2f},{:.2f}\n", std::get<int>(row.frame),
                        CsvText(row.label), row.score, row.box.x_min, row.box.y_min, row.box.x_max,
                        row.box.y_max);
  }
  return text;
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/detections_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/error.h"
#include "dataset/text_file.h"

namespace soslam {
namespace {

constexpr std::array kColumns = {"frame", "object_id", "label", "score", "x1", "y1", "x2", "y2"};

// Where each of kColumns stands in a row.
std::array<size_t, kColumns.size()> ColumnPositions(
    const std::vector<std::string_view>& header_fields, const std::string& place) {
  std::array<size_t, kColumns.size()> positions;
  for (size_t i = 0; i < kColumns.size(); ++i) {
    const auto found = std::find(header_fields.begin(), header_fields.end(), kColumns[i]);
    if (found == header_fields.end() ||
        std::find(found + 1, header_fields.end(), kColumns[i]) != header_fields.end()) {
      throw InputError(fmt::format("{}: column '{}' is {}; expected each of {} once", place,
                                   kColumns[i], found == header_fields.end() ? "missing" : "twice",
                                   fmt::join(kColumns, ",")));
    }
    positions[i] = static_cast<size_t>(found - header_fields.begin());
  }
  return positions;
}

}  // namespace

std::vector<DetectionRow> ReadDetections(const std::filesystem::path& path) {
  const std::vector<TextLine> lines = ReadTextLines(path);
  if (lines.empty()) {
    throw InputError(
        fmt::format("{}: is empty; expected a header {}", path.string(), fmt::join(kColumns, ",")));
  }
  const auto header_fields = SplitFields(lines[0].text);
  const auto positions = ColumnPositions(header_fields, lines[0].place);

  std::vector<DetectionRow> rows;
  for (size_t i = 1; i < lines.size(); ++i) {
    const std::string& place = lines[i].place;
    const auto fields = SplitFields(lines[i].text);
    if (fields.size() != header_fields.size()) {
      throw InputError(fmt::format("{}: has {} fields; expected {}, as the header has", place,
                                   fields.size(), header_fields.size()));
    }
    const auto integer = [&](size_t column) {
      return ParseInteger(fields[positions[column]], place, kColumns[column]);
    };
    const auto real = [&](size_t column) {
      return ParseReal(fields[positions[column]], place, kColumns[column]);
    };
    const std::string_view label = fields[positions[2]];
    if (label.empty()) throw InputError(place + ": label is empty; expected a category");
    rows.push_back({place, integer(0), integer(1), std::string(label), real(3),
                    Box{real(4), real(5), real(6), real(7)}});
  }
  return rows;
}

}  // namespace soslam

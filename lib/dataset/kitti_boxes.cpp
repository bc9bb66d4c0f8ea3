// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/kitti_boxes.h"

#include <fmt/format.h>

#include <array>
#include <string>

#include "base/error.h"
#include "dataset/text_file.h"

namespace soslam {
namespace {

LabelledBox ParseLine(const TextLine& line, const std::string& label) {
  constexpr std::array kNames = {"frame", "x1", "y1", "x2", "y2", "score"};
  const auto fields = SplitFields(line.text);
  if (fields.size() != kNames.size()) {
    throw InputError(fmt::format("{}: has {} fields; expected {}", line.place, fields.size(),
                                 fmt::join(kNames, ",")));
  }
  const auto real = [&](size_t i) { return ParseReal(fields[i], line.place, kNames[i]); };
  const Box box{real(1), real(2), real(3), real(4)};
  if (box.Width() < 0.0 || box.Height() < 0.0) {
    throw InputError(fmt::format("{}: box is {} {} {} {}; expected x1 <= x2 and y1 <= y2",
                                 line.place, box.x_min, box.y_min, box.x_max, box.y_max));
  }
  const int frame = ParseInteger(fields[0], line.place, kNames[0]);
  if (frame < 0)
    throw InputError(fmt::format("{}: frame is {}; expected 0 or more", line.place, frame));
  return {line.place, frame, label, real(5), box};
}

}  // namespace

std::vector<LabelledBox> ReadKittiBoxes(const std::filesystem::path& path) {
  const std::string label = std::filesystem::absolute(path).parent_path().filename().string();
  std::vector<LabelledBox> boxes;
  for (const TextLine& line : ReadTextLines(path)) boxes.push_back(ParseLine(line, label));
  return boxes;
}

}  // namespace soslam

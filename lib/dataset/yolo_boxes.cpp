// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/yolo_boxes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "base/error.h"
#include "dataset/text_file.h"
#include "dataset/yolo_columns.h"

namespace soslam {
namespace {

constexpr double kRounding = 1e-3;  // files round to three digits at least
// Largest overhang of boxes by annotators and detectors, fraction.
constexpr double kMostBeyond = 0.05;

YoloRow ParseLine(const TextLine& line, const std::string& image,
                  const std::array<const char*, 4>& names) {
  const auto words = SplitWords(line.text);
  if (words.size() < 5 || words.size() > 7) {
    throw InputError(fmt::format(
        "{}: has {} numbers; expected class {} [score] [track]{}", line.place, words.size(),
        fmt::join(names, " "),
        words.size() > 7 ? ": labels of segmentation (polygons), poses and oriented boxes are not "
                           "read, save boxes"
                         : ""));
  }
  YoloRow row{line.place, image, ParseInteger(words[0], line.place, "class"), {}, {}};
  for (size_t i = 0; i < names.size(); ++i) {
    row.box[i] = ParseReal(words[i + 1], line.place, names[i]);
  }
  for (size_t i = 5; i < words.size(); ++i) {
    row.extras.push_back(ParseReal(words[i], line.place, fmt::format("number {}", i + 1)));
  }
  return row;
}

// Box with corners in fractions of the image.
Box FractionsBox(const std::array<double, 4>& values, const std::string& place) {
  for (size_t i = 0; i < values.size(); ++i) {
    const double least = i < 2 ? -kMostBeyond : -kRounding;
    if (values[i] >= least && values[i] <= 1.0 + kMostBeyond) continue;
    throw InputError(
        fmt::format("{}: has {}; expected fractions of the image's width and height, 0 to 1", place,
                    values[i]));
  }
  const auto [cx, cy, w, h] = values;
  return {cx - 0.5 * w, cy - 0.5 * h, cx + 0.5 * w, cy + 0.5 * h};
}

// Largest overhang of a box beyond the image, in fractions.
double Beyond(const Box& box) {
  return std::max({0.0, -box.x_min, -box.y_min, box.x_max - 1.0, box.y_max - 1.0});
}

Box CutToImage(const Box& box) {
  return {std::max(box.x_min, 0.0), std::max(box.y_min, 0.0), std::min(box.x_max, 1.0),
          std::min(box.y_max, 1.0)};
}

Box PixelBox(const std::array<double, 4>& values, const std::string& place) {
  const auto [x, y, w, h] = values;
  if (std::max({x, y, w, h}) <= 1.0) {
    throw InputError(
        fmt::format("{}: all of {} are at most 1; expected pixels", place, fmt::join(values, " ")));
  }
  if (w < 0.0 || h < 0.0) {
    throw InputError(fmt::format("{}: size is {} x {}; expected pixels, not below 0", place, w, h));
  }
  return FromCornerOrigin({x, y, x + w, y + h});
}

std::vector<YoloRow> ReadRows(const YoloTexts& texts, const std::array<const char*, 4>& names) {
  std::vector<YoloRow> rows;
  for (const YoloText& text : texts.images) {
    for (const TextLine& line : text.lines) rows.push_back(ParseLine(line, text.image, names));
  }
  ReadYoloExtras(&rows);
  return rows;
}

LabelledBox LabelledBoxOf(const YoloRow& row, const Box& box,
                          const std::vector<std::string>& labels) {
  if (row.class_index < 0 || row.class_index >= static_cast<int>(labels.size())) {
    throw InputError(fmt::format("{}: class is {}; expected 0 to {}, one of {} labels", row.place,
                                 row.class_index, labels.size() - 1, labels.size()));
  }
  return {row.place, row.image, labels[static_cast<size_t>(row.class_index)],
          row.score, box,       row.track};
}

}  // namespace

std::vector<LabelledBox> ReadNormalisedYoloBoxes(const YoloTexts& texts,
                                                 const std::vector<std::string>& labels,
                                                 int image_width, int image_height,
                                                 RejectionCounts* corrected) {
  std::vector<LabelledBox> boxes;
  for (const YoloRow& row : ReadRows(texts, {"cx", "cy", "w", "h"})) {
    Box box = FractionsBox(row.box, row.place);
    const double beyond = Beyond(box);
    if (beyond <= kMostBeyond) box = CutToImage(box);
    if (beyond > kRounding && beyond <= kMostBeyond) ++(*corrected)["cut_to_image"];
    boxes.push_back(
        LabelledBoxOf(row,
                      FromCornerOrigin({box.x_min * image_width, box.y_min * image_height,
                                        box.x_max * image_width, box.y_max * image_height}),
                      labels));
  }
  return boxes;
}

std::vector<LabelledBox> ReadPixelYoloBoxes(const YoloTexts& texts,
                                            const std::vector<std::string>& labels) {
  std::vector<LabelledBox> boxes;
  for (const YoloRow& row : ReadRows(texts, {"x", "y", "w", "h"})) {
    boxes.push_back(LabelledBoxOf(row, PixelBox(row.box, row.place), labels));
  }
  return boxes;
}

}  // namespace soslam

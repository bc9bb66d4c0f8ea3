// SPDX-License-Identifier: BSD-3-Clause
#include "image/yolo_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/core.hpp>
#include <opencv2/dnn.hpp>

#include "base/error.h"

namespace soslam {
namespace {

constexpr int kYoloStrides[] = {8, 16, 32};

// The output as one row per candidate.
cv::Mat CandidateRows(const cv::Mat& output, const YoloFormat& format, const std::string& network) {
  const bool is_transposed = format.layout == YoloLayout::kV8;
  const int fields = format.layout == YoloLayout::kEndToEnd
                         ? 6
                         : (is_transposed ? 4 : 5) + format.classes + format.extra_columns;
  const std::vector<int> shape(output.size.p, output.size.p + output.dims);
  if (shape.size() != 3 || shape[0] != 1 || shape[is_transposed ? 1 : 2] != fields ||
      output.type() != CV_32FC1) {
    throw InputError(fmt::format(
        "{}: output has shape [{}]; expected {} of layout {} with {} classes", network,
        fmt::join(shape, ", "),
        is_transposed ? fmt::format("[1, {}, N]", fields) : fmt::format("[1, N, {}]", fields),
        kYoloLayoutNames[static_cast<int>(format.layout)], format.classes));
  }
  const cv::Mat rows(shape[1], shape[2], CV_32FC1, const_cast<uchar*>(output.data));
  return is_transposed ? cv::Mat(rows.t()) : rows;
}

double LargestSide(const cv::Mat& rows) {
  double largest = 0.0;
  if (!rows.empty()) cv::minMaxLoc(rows.colRange(2, 4), nullptr, &largest);
  return largest;
}

// Converts boxes from cells of YOLOX's grids to pixels. The rows are grid by grid, the finest
// first, each row by row. Throws InputError for boxes that are in pixels already.
cv::Mat FromYoloxGrids(const cv::Mat& rows, const cv::Size& input, const std::string& network) {
  if (rows.rows != YoloCells(input)) {
    throw InputError(fmt::format(
        "{}: output has {} candidates; expected {} of layout yolox for an input of {} x {} pixels",
        network, rows.rows, YoloCells(input), input.width, input.height));
  }
  constexpr double kMostLogCells = 20.0;
  if (LargestSide(rows) > kMostLogCells) {
    throw InputError(fmt::format(
        "{}: the largest side of a box in the output is {:.2f}; expected logarithms, of at most {} "
        "(YOLOX that was exported with --decode_in_inference has pixels: output_layout = v5)",
        network, LargestSide(rows), kMostLogCells));
  }
  cv::Mat decoded = rows.clone();
  int index = 0;
  for (const int stride : kYoloStrides) {
    const int columns = input.width / stride;
    const int cells = columns * (input.height / stride);
    const auto pixels = static_cast<float>(stride);
    for (int cell = 0; cell < cells; ++cell, ++index) {
      const int cell_column = cell % columns;
      const int cell_row = cell / columns;
      float* row = decoded.ptr<float>(index);
      row[0] = (row[0] + static_cast<float>(cell_column)) * pixels;
      row[1] = (row[1] + static_cast<float>(cell_row)) * pixels;
      row[2] = std::exp(row[2]) * pixels;
      row[3] = std::exp(row[3]) * pixels;
    }
  }
  return decoded;
}

// Throws InputError for YOLOX's candidates in cells, which would pass for tiny boxes.
void CheckInPixels(const cv::Mat& rows, const cv::Size& input, const std::string& network) {
  if (rows.rows != YoloCells(input) || LargestSide(rows) >= kYoloStrides[0]) return;
  throw InputError(fmt::format(
      "{}: the largest side of a box in the output is {:.2f}; expected pixels (YOLOX as it is "
      "published has logarithms: output_layout = yolox)",
      network, LargestSide(rows)));
}

// One row of an output.
YoloDetection ReadCandidate(const float* row, const YoloFormat& format) {
  if (format.layout == YoloLayout::kEndToEnd) {
    const bool is_class = row[5] >= 0.0F && row[5] < static_cast<float>(format.classes) &&
                          row[5] == std::floor(row[5]);
    return {is_class ? static_cast<int>(row[5]) : -1, row[4], {row[0], row[1], row[2], row[3]}};
  }
  const bool has_objectness =
      format.layout == YoloLayout::kV5 || format.layout == YoloLayout::kYolox;
  const float* scores = row + (has_objectness ? 5 : 4);
  const float* best = std::max_element(scores, scores + format.classes);
  const double cx = row[0], cy = row[1], half_w = 0.5 * row[2], half_h = 0.5 * row[3];
  return {static_cast<int>(best - scores),
          has_objectness ? static_cast<double>(*best) * row[4] : *best,
          {cx - half_w, cy - half_h, cx + half_w, cy + half_h}};
}

// Throws an error for a candidate that no network of this format returns.
void CheckPossible(const YoloDetection& found, int index, const YoloFormat& format,
                   const std::string& network) {
  const Box& box = found.box;
  if (!std::isfinite(found.score + box.x_min + box.y_min + box.x_max + box.y_max)) {
    throw NumericalError(
        fmt::format("{}: candidate {} of the output is not finite", network, index));
  }
  constexpr double kMostScore = 1.01;  // room for rounding
  if (box.Width() >= 0.0 && box.Height() >= 0.0 && found.score <= kMostScore &&
      found.class_index >= 0) {
    return;
  }
  throw InputError(fmt::format(
      "{}: candidate {} of the output is {:.4g} x {:.4g} pixels with score {:.4g}{}; expected no "
      "negative size, a score of at most 1 and one of {} classes. Taken for {}: another layout is "
      "likely",
      network, index, box.Width(), box.Height(), found.score,
      found.class_index < 0 ? " and no class" : "", format.classes, format.Text()));
}

}  // namespace

std::string YoloFormat::Text() const {
  return fmt::format("layout {}, pixel values {}, input of {} x {} pixels",
                     kYoloLayoutNames[static_cast<int>(layout)],
                     kPixelValuesNames[static_cast<int>(pixel_values)], input.width, input.height);
}

int YoloCells(const cv::Size& input) {
  int cells = 0;
  for (const int stride : kYoloStrides) cells += (input.width / stride) * (input.height / stride);
  return cells;
}

bool HasBoxesInCells(const cv::Mat& output) {
  return LargestSide(cv::Mat(output.size[1], output.size[2], CV_32FC1, output.data)) <
         kYoloStrides[0];
}

std::vector<YoloDetection> ReadYoloOutput(const cv::Mat& output, const YoloFormat& format,
                                          double min_score, const std::string& network) {
  cv::Mat rows = CandidateRows(output, format, network);
  if (format.layout == YoloLayout::kV5) CheckInPixels(rows, format.input, network);
  if (format.layout == YoloLayout::kYolox) rows = FromYoloxGrids(rows, format.input, network);
  std::vector<YoloDetection> found;
  for (int i = 0; i < rows.rows; ++i) {
    const YoloDetection candidate = ReadCandidate(rows.ptr<float>(i), format);
    if (candidate.score < min_score) continue;
    CheckPossible(candidate, i, format, network);
    found.push_back(candidate);
  }
  return found;
}

std::vector<YoloDetection> WithoutOverlaps(const std::vector<YoloDetection>& boxes,
                                           const std::vector<int>& groups, double max_overlap) {
  std::map<int, std::vector<YoloDetection>> boxes_of_group;
  for (const YoloDetection& box : boxes) {
    boxes_of_group[groups.at(box.class_index)].push_back(box);
  }
  std::vector<YoloDetection> kept;
  for (const auto& [group, members] : boxes_of_group) {
    std::vector<cv::Rect2d> rectangles;
    std::vector<float> scores;
    for (const YoloDetection& box : members) {
      rectangles.emplace_back(box.box.x_min, box.box.y_min, box.box.Width(), box.box.Height());
      scores.push_back(static_cast<float>(box.score));
    }
    std::vector<int> indices;
    cv::dnn::NMSBoxes(rectangles, scores, 0.0F, static_cast<float>(max_overlap), indices);
    for (const int index : indices) kept.push_back(members[index]);
  }
  std::ranges::stable_sort(kept, std::ranges::greater(), &YoloDetection::score);
  return kept;
}

}  // namespace soslam

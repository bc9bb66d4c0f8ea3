// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/image/network_output.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/core.hpp>
#include <opencv2/dnn.hpp>
#include <stdexcept>

#include "soslam/base/error.h"

namespace soslam {
namespace {

constexpr int kYoloStrides[] = {8, 16, 32};

// An output as a matrix with the rows of its last side. Throws InputError unless it has the shape,
// -1 for any side.
cv::Mat AsMatrix(const cv::Mat& output, const std::vector<int>& expected,
                 const NetworkFormat& format, const std::string& network) {
  const std::vector<int> shape(output.size.p, output.size.p + output.dims);
  if (output.type() == CV_32FC1 && std::ranges::equal(shape, expected, [](int side, int wanted) {
        return wanted < 0 || side == wanted;
      })) {
    const int columns = shape.back();
    const int rows = columns == 0 ? 0 : static_cast<int>(output.total()) / columns;
    return {rows, columns, CV_32FC1, const_cast<uchar*>(output.data)};
  }
  std::vector<std::string> sides;
  for (const int side : expected) sides.push_back(side < 0 ? "N" : std::to_string(side));
  throw InputError(
      fmt::format("{}: output has shape [{}]; expected [{}] of layout {} with {} classes", network,
                  fmt::join(shape, ", "), fmt::join(sides, ", "),
                  kOutputLayoutNames[static_cast<int>(format.layout)], format.classes));
}

// Scores of classes in place of logits: each by itself, or shares of all in a row.
cv::Mat ComputeScores(const cv::Mat& logits, bool is_softmax, const std::string& network) {
  double least = 0.0, most = 0.0;
  cv::minMaxLoc(logits, &least, &most);
  if (least >= 0.0 && most <= 1.0 && most > 0.0) {
    throw InputError(
        fmt::format("{}: its logits are from {:.3g} to {:.3g}; expected negative ones: "
                    "these are probabilities already, export it without a sigmoid",
                    network, least, most));
  }
  cv::Mat scores(logits.size(), CV_32FC1);
  for (int i = 0; i < logits.rows; ++i) {
    const float* logit = logits.ptr<float>(i);
    const double largest = *std::max_element(logit, logit + logits.cols);
    double sum = 0.0;
    for (int j = 0; j < logits.cols; ++j) sum += std::exp(logit[j] - largest);
    for (int j = 0; j < logits.cols; ++j) {
      scores.at<float>(i, j) = static_cast<float>(is_softmax ? std::exp(logit[j] - largest) / sum
                                                             : 1.0 / (1.0 + std::exp(-logit[j])));
    }
  }
  return scores;
}

// The outputs as one row per candidate: that of kEndToEnd, or centre and size of the box,
// objectness if there is one, and scores of classes.
cv::Mat CandidateRows(const std::vector<cv::Mat>& outputs, const NetworkFormat& format,
                      const std::string& network) {
  const auto matrix = [&](int index, const std::vector<int>& shape) {
    return AsMatrix(outputs.at(format.outputs.at(index)), shape, format, network);
  };
  constexpr int kAny = -1;
  const int fields = format.classes + format.extra_columns;
  cv::Mat rows;
  switch (format.layout) {
    case OutputLayout::kV5:
    case OutputLayout::kYolox:
      return matrix(0, {1, kAny, 5 + fields});
    case OutputLayout::kV8:
      return matrix(0, {1, 4 + fields, kAny}).t();
    case OutputLayout::kEndToEnd:
      return matrix(0, {1, kAny, 6});
    case OutputLayout::kDetr:
    case OutputLayout::kDetrSoftmax: {
      const bool is_softmax = format.layout == OutputLayout::kDetrSoftmax;
      const cv::Mat boxes = matrix(0, {1, kAny, 4}).clone();
      const cv::Mat logits = matrix(1, {1, boxes.rows, is_softmax ? fields + 1 : fields});
      for (const int x : {0, 2}) boxes.col(x) *= format.input.width;
      for (const int y : {1, 3}) boxes.col(y) *= format.input.height;
      cv::hconcat(boxes, ComputeScores(logits, is_softmax, network), rows);
      return rows;
    }
    case OutputLayout::kDetrBoxes: {
      const cv::Mat boxes = matrix(0, {1, kAny, 4});
      const cv::Mat scores = matrix(1, {1, boxes.rows}), classes = matrix(2, {1, boxes.rows});
      cv::hconcat(std::vector<cv::Mat>{boxes, scores.t(), classes.t()}, rows);
      return rows;
    }
    case OutputLayout::kPaddle: {
      const cv::Mat corners = matrix(0, {1, kAny, 4});
      const cv::Mat from = corners.colRange(0, 2), to = corners.colRange(2, 4);
      cv::hconcat(std::vector<cv::Mat>{0.5 * (from + to), to - from,
                                       matrix(1, {1, fields, corners.rows}).t()},
                  rows);
      return rows;
    }
    case OutputLayout::kPaddleNms: {
      const cv::Mat found = matrix(0, {kAny, 6});
      cv::hconcat(std::vector<cv::Mat>{found.colRange(2, 6), found.col(1), found.col(0)}, rows);
      return rows;
    }
    case OutputLayout::kAuto:
      break;
  }
  throw std::logic_error("the layout of the outputs is not known");
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

}  // namespace

LayoutProperties PropertiesOf(OutputLayout layout) {
  switch (layout) {
    case OutputLayout::kV5:
    case OutputLayout::kYolox:
      return {.has_objectness = true, .may_overlap = true, .is_for_stretched = false};
    case OutputLayout::kV8:
      return {.may_overlap = true, .is_for_stretched = false};
    case OutputLayout::kEndToEnd:
      return {.has_one_class = true, .is_for_stretched = false};
    case OutputLayout::kDetrBoxes:
    case OutputLayout::kPaddleNms:
      return {.has_one_class = true};
    case OutputLayout::kPaddle:
      return {.may_overlap = true};
    case OutputLayout::kDetr:
    case OutputLayout::kDetrSoftmax:
    case OutputLayout::kAuto:
      break;
  }
  return {};
}

std::string NetworkFormat::Text() const {
  return fmt::format("layout {}, pixel values {}, input of {} x {} pixels",
                     kOutputLayoutNames[static_cast<int>(layout)],
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

bool HasNoObjectClass(const cv::Mat& logits) {
  const int classes = logits.size[2];
  const cv::Mat rows(logits.size[1], classes, CV_32FC1, logits.data);
  return classes > 1 && 2 * cv::countNonZero(rows.col(classes - 1) > 0.0F) > rows.rows;
}

std::vector<NetworkDetection> ReadNetworkOutput(const std::vector<cv::Mat>& outputs,
                                                const NetworkFormat& format, double min_score,
                                                const std::string& network) {
  if (outputs.at(format.outputs.at(0)).empty()) return {};
  cv::Mat rows = CandidateRows(outputs, format, network);
  // YOLOX's candidates in cells would pass for tiny boxes.
  if (format.layout == OutputLayout::kV5 && rows.rows == YoloCells(format.input) &&
      LargestSide(rows) < kYoloStrides[0]) {
    throw InputError(fmt::format(
        "{}: the largest side of a box in the output is {:.2f}; expected pixels (YOLOX as it is "
        "published has logarithms: output_layout = yolox)",
        network, LargestSide(rows)));
  }
  if (format.layout == OutputLayout::kYolox) rows = FromYoloxGrids(rows, format.input, network);
  const LayoutProperties properties = PropertiesOf(format.layout);
  std::vector<NetworkDetection> found;
  for (int i = 0; i < rows.rows; ++i) {
    const float* row = rows.ptr<float>(i);
    NetworkDetection candidate = {};
    if (properties.has_one_class) {
      const bool is_class = row[5] >= 0.0F && row[5] < static_cast<float>(format.classes) &&
                            row[5] == std::floor(row[5]);
      candidate = {
          is_class ? static_cast<int>(row[5]) : -1, row[4], {row[0], row[1], row[2], row[3]}};
    } else {
      const float* scores = row + (properties.has_objectness ? 5 : 4);
      const float* best = std::max_element(scores, scores + format.classes);
      const double cx = row[0], cy = row[1], half_w = 0.5 * row[2], half_h = 0.5 * row[3];
      candidate = {static_cast<int>(best - scores),
                   properties.has_objectness ? static_cast<double>(*best) * row[4] : *best,
                   {cx - half_w, cy - half_h, cx + half_w, cy + half_h}};
    }
    if (candidate.score < min_score) continue;
    const Box& box = candidate.box;
    if (!std::isfinite(candidate.score + box.x_min + box.y_min + box.x_max + box.y_max)) {
      throw NumericalError(fmt::format("{}: candidate {} of the output is not finite", network, i));
    }
    constexpr double kMostScore = 1.01;  // room for rounding
    if (box.Width() < 0.0 || box.Height() < 0.0 || candidate.score > kMostScore ||
        candidate.class_index < 0) {
      throw InputError(fmt::format(
          "{}: candidate {} of the output is {:.4g} x {:.4g} pixels with score {:.4g}{}; expected "
          "no negative size, a score of at most 1 and one of {} classes. Taken for {}: another "
          "layout is likely",
          network, i, box.Width(), box.Height(), candidate.score,
          candidate.class_index < 0 ? " and no class" : "", format.classes, format.Text()));
    }
    found.push_back(candidate);
  }
  return found;
}

std::vector<NetworkDetection> WithoutOverlaps(const std::vector<NetworkDetection>& boxes,
                                              const std::vector<int>& groups, double max_overlap) {
  std::map<int, std::vector<NetworkDetection>> boxes_of_group;
  for (const NetworkDetection& box : boxes) {
    boxes_of_group[groups.at(box.class_index)].push_back(box);
  }
  std::vector<NetworkDetection> kept;
  for (const auto& [group, members] : boxes_of_group) {
    std::vector<cv::Rect2d> rectangles;
    std::vector<float> scores;
    for (const NetworkDetection& box : members) {
      rectangles.emplace_back(box.box.x_min, box.box.y_min, box.box.Width(), box.box.Height());
      scores.push_back(static_cast<float>(box.score));
    }
    std::vector<int> indices;
    cv::dnn::NMSBoxes(rectangles, scores, 0.0F, static_cast<float>(max_overlap), indices);
    for (const int index : indices) kept.push_back(members[index]);
  }
  std::ranges::stable_sort(kept, std::ranges::greater(), &NetworkDetection::score);
  return kept;
}

}  // namespace soslam

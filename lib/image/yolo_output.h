// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "geometry/box.h"

namespace soslam {

// Layout of a YOLO network's output. N candidates, C classes; centre, width, height and corners are
// in pixels of the network's input.
enum class YoloLayout {
  kAuto,      // the network's file and output decide
  kV5,        // [1, N, 5 + C]: cx cy w h, objectness, a score of each class. Also YOLOv7.
  kV8,        // [1, 4 + C, N]: transposed, without objectness. Also YOLO11.
  kYolox,     // as kV5, but cx cy in cells and w h as logarithms of cells: YOLOX as published.
  kEndToEnd,  // [1, N, 6]: x1 y1 x2 y2, score, class; overlaps are removed. YOLOv10, YOLO26.
};
inline constexpr const char* kYoloLayoutNames[] = {"auto", "v5", "v8", "yolox", "end_to_end"};

// Pixel values that a network expects.
enum class PixelValues {
  kAuto,     // the network's file and output decide
  kRgbUnit,  // red, green, blue from 0 to 1: Ultralytics' networks
  kBgrByte,  // blue, green, red from 0 to 255: YOLOX
};
inline constexpr const char* kPixelValuesNames[] = {"auto", "rgb_0_1", "bgr_0_255"};

// What a network takes, and what it returns; nothing is kAuto.
struct YoloFormat {
  YoloLayout layout = YoloLayout::kV5;
  PixelValues pixel_values = PixelValues::kRgbUnit;
  cv::Size input;  // px
  int classes = 0;
  int extra_columns = 0;  // numbers after the class scores: coefficients of masks, key points

  // The format for error messages: "layout v5, pixel values rgb_0_1, input of 640 x 480 pixels".
  std::string Text() const;
};

// A detected object: class, score and box.
struct YoloDetection {
  int class_index;
  double score;
  Box box;
};

// Number of cells of all grids of YOLO's networks (8, 16 and 32 pixels a cell) over an input.
int YoloCells(const cv::Size& input);

// True if the boxes of an output of layout v5 or yolox are in cells: the logarithms of widths and
// heights are small, whereas among that many boxes in pixels some are large.
bool HasBoxesInCells(const cv::Mat& output);

// The candidates with at least `min_score` in the output of a YOLO network, each with its best
// class; the score is that of the class, times the objectness if there is one. Boxes are in pixels
// of the network's input from its outer corner. `network` is its name in error messages. Throws
// InputError when the output does not have this format, or has boxes or scores that cannot be;
// NumericalError for a box or score that is not finite.
std::vector<YoloDetection> ReadYoloOutput(const cv::Mat& output, const YoloFormat& format,
                                          double min_score, const std::string& network);

// Non-maximum suppression: removes boxes that overlap one of a higher score and the same group of
// classes by more than `max_overlap` (IoU). `groups` has the group of each class, from 0 on. Sorted
// by descending score.
std::vector<YoloDetection> WithoutOverlaps(const std::vector<YoloDetection>& boxes,
                                           const std::vector<int>& groups, double max_overlap);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "soslam/geometry/box.h"

namespace soslam {

// Layout of a network's outputs. N candidates, C classes; boxes are centre, width and height, or
// two corners (x1 y1 x2 y2), in pixels of the network's input unless stated otherwise.
enum class OutputLayout {
  kAuto,         // the network's file and outputs decide
  kV5,           // [1, N, 5 + C]: cx cy w h, objectness, a score of each class. Also YOLOv7.
  kV8,           // [1, 4 + C, N]: transposed, without objectness. Also YOLO11.
  kYolox,        // as kV5, but cx cy in cells and w h as logarithms of cells: YOLOX as published.
  kEndToEnd,     // [1, N, 6]: corners, score, class; overlaps are removed. YOLOv10, YOLO26.
  kDetr,         // [1, N, 4]: cx cy w h in fractions of the input; [1, N, C]: logits of classes.
  kDetrSoftmax,  // as kDetr with [1, N, C + 1]: the last logit is that of no object.
  kDetrBoxes,    // [1, N, 4]: corners; [1, N]: scores; [1, N]: classes. RT-DETR, D-FINE.
  kPaddle,       // [1, N, 4]: corners; [1, C, N]: scores. PaddleDetection without suppression.
  kPaddleNms,    // [N, 6]: class, score, corners; overlaps are removed. PaddleDetection.
};
inline constexpr const char* kOutputLayoutNames[] = {
    "auto", "v5",           "v8",         "yolox",  "end_to_end",
    "detr", "detr_softmax", "detr_boxes", "paddle", "paddle_nms"};

// Differences between the layouts.
struct LayoutProperties {
  bool has_objectness = false;   // scores of classes are given the presence of an object
  bool has_one_class = false;    // a candidate has one class, with its score
  bool may_overlap = false;      // overlaps are not removed yet
  bool is_for_stretched = true;  // images are stretched to the input, not padded
};
LayoutProperties PropertiesOf(OutputLayout layout);

// Pixel values that a network expects.
enum class PixelValues {
  kAuto,         // the network's file and output decide
  kRgbUnit,      // red, green, blue from 0 to 1: Ultralytics' networks, RT-DETR, D-FINE
  kBgrByte,      // blue, green, red from 0 to 255: YOLOX
  kRgbImageNet,  // as kRgbUnit, less ImageNet's mean, by its standard deviation: RF-DETR, PicoDet
};
inline constexpr const char* kPixelValuesNames[] = {"auto", "rgb_0_1", "bgr_0_255", "rgb_imagenet"};

// A network's input and output; nothing is kAuto.
struct NetworkFormat {
  OutputLayout layout = OutputLayout::kV5;
  PixelValues pixel_values = PixelValues::kRgbUnit;
  cv::Size input;  // px
  int classes = 0;
  int extra_columns = 0;  // numbers after the class scores: masks, key points, an unused class
  std::vector<int> outputs = {0};  // indices of the outputs, in the order of OutputLayout

  // The format for error messages: "layout v5, pixel values rgb_0_1, input of 640 x 480 pixels".
  std::string Text() const;
};

// A detected object: class, score and box.
struct NetworkDetection {
  int class_index;
  double score;
  Box box;
};

// Number of cells of all grids of YOLO's networks (8, 16 and 32 pixels a cell) over an input.
int YoloCells(const cv::Size& input);

// True if the last of the logits [1, N, C] is that of no object, on an image that shows none: it
// alone would be a detection in most candidates.
bool HasNoObjectClass(const cv::Mat& logits);

// True if the boxes of an output of layout v5 or yolox are in cells: the logarithms of widths and
// heights are small, whereas among that many boxes in pixels some are large.
bool HasBoxesInCells(const cv::Mat& output);

// The candidates with at least `min_score` in the outputs of a network, each with its best class;
// the score is that of the class, times the objectness if there is one. Boxes are in pixels of the
// network's input from its outer corner. `network` is its name in error messages. Throws InputError
// when the outputs do not have this format, or have boxes or scores that cannot be; NumericalError
// for a box or score that is not finite.
std::vector<NetworkDetection> ReadNetworkOutput(const std::vector<cv::Mat>& outputs,
                                                const NetworkFormat& format, double min_score,
                                                const std::string& network);

// Non-maximum suppression: removes boxes that overlap one of a higher score and the same group of
// classes by more than `max_overlap` (IoU). `groups` has the group of each class, from 0 on. Sorted
// by descending score.
std::vector<NetworkDetection> WithoutOverlaps(const std::vector<NetworkDetection>& boxes,
                                              const std::vector<int>& groups, double max_overlap);

}  // namespace soslam

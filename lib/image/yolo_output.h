// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "geometry/box.h"
#include "image/detector_options.h"

namespace soslam {

// A detected object: class, score and box.
struct YoloDetection {
  int class_index;
  double score;
  Box box;
};

// The candidates with at least `min_score` in the output of a YOLO network, each with its best
// class; the score is that of the class, times the objectness if there is one. Boxes are in pixels
// of the network's input, which is of size `input`, from its outer corner. `network` is its name in
// error messages. Throws InputError when the output does not have this layout for that many
// classes;
// NumericalError for a box or score that is not finite.
std::vector<YoloDetection> ReadYoloOutput(const cv::Mat& output, YoloLayout layout,
                                          const cv::Size& input, int classes, double min_score,
                                          const std::string& network);

// Non-maximum suppression: removes boxes that overlap one of the same class and higher score by
// more than `max_overlap` (IoU). Sorted by descending score.
std::vector<YoloDetection> WithoutOverlaps(const std::vector<YoloDetection>& boxes, int classes,
                                           double max_overlap);

}  // namespace soslam

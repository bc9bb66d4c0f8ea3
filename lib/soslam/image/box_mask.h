// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <opencv2/core.hpp>
#include <vector>

#include "soslam/geometry/box.h"

namespace soslam {

// CV_8UC1: 0 at pixels whose centre is in one of the boxes, 255 elsewhere.
inline cv::Mat MaskOutBoxes(const std::vector<Box>& boxes, const cv::Size& size) {
  cv::Mat mask(size, CV_8UC1, cv::Scalar(255));
  for (const Box& box : boxes) {
    const auto cut = CutToImage(box, size.width, size.height);
    if (!cut) continue;
    const cv::Point first(static_cast<int>(std::ceil(cut->x_min)),
                          static_cast<int>(std::ceil(cut->y_min)));
    const cv::Point end(static_cast<int>(std::floor(cut->x_max)) + 1,
                        static_cast<int>(std::floor(cut->y_max)) + 1);
    if (end.x > first.x && end.y > first.y) mask(cv::Rect(first, end)) = 0;
  }
  return mask;
}

}  // namespace soslam

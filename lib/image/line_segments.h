// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace soslam {

// A straight edge in an image, pixels.
struct LineSegment {
  Eigen::Vector2d begin;
  Eigen::Vector2d end;
};

// The straight edges of a grey image (CV_8UC1) that are at least this long (px): the line segment
// detector of Grompone von Gioi et al. (2010).
std::vector<LineSegment> FindLineSegments(const cv::Mat& grey, double min_length_px);

}  // namespace soslam

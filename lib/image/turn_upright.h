// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

namespace soslam {

// Turns an image upright, as viewers show it, from the stored pixels and EXIF's orientation. That
// states at which sides of the upright image the first stored row and the first stored column are:
//   1 top, left    2 top, right    3 bottom, right    4 bottom, left
//   5 left, top    6 right, top    7 right, bottom    8 left, bottom
cv::Mat TurnUpright(const cv::Mat& stored, int exif_orientation);

}  // namespace soslam

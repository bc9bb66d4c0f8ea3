// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

namespace soslam {

// An image as viewers show it, from the pixels as a file stores them and EXIF's orientation: what
// its first row and its first column show, top left to bottom right.
//   1 top, left    2 top, right    3 bottom, right    4 bottom, left
//   5 left, top    6 right, top    7 right, bottom    8 left, bottom
cv::Mat TurnUpright(const cv::Mat& stored, int exif_orientation);

}  // namespace soslam

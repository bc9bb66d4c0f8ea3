// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include "geometry/box.h"
#include "model/image_matches.h"

namespace soslam {

// The colours of an image, CV_8UC3 in the order of OpenCV, in a box, which lies at least partly in
// it. Pixels in the middle of the box, which are hardly of the background, weigh most.
BoxColours ColoursIn(const cv::Mat& bgr, const Box& box);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "soslam/geometry/box.h"
#include "soslam/geometry/box_colours.h"

namespace cv {
class Mat;
}

namespace soslam {

// The colours of an image, CV_8UC3 in the order of OpenCV, in a box, which lies at least partly in
// it. Pixels in the middle of the box, which are hardly of the background, weigh most.
BoxColours ColoursIn(const cv::Mat& bgr, const Box& box);

}  // namespace soslam

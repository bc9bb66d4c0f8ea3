// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "geometry/box.h"

namespace cv {
class Mat;
}

namespace soslam {

// Colours of an image in a box: square roots of the shares of a histogram over CIELAB, so that the
// scalar product of two is their Bhattacharyya coefficient, times 255 and rounded.
inline constexpr int kLightnessBins = 4;
inline constexpr int kChromaBins = 8;  // of each of a* and b*
using BoxColours = Eigen::Matrix<std::uint8_t, kLightnessBins * kChromaBins * kChromaBins, 1>;

// The colours of an image, CV_8UC3 in the order of OpenCV, in a box, which lies at least partly in
// it. Pixels in the middle of the box, which are hardly of the background, weigh most.
BoxColours ColoursIn(const cv::Mat& bgr, const Box& box);

}  // namespace soslam

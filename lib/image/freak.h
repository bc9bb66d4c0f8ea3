// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <bitset>
#include <cstddef>
#include <opencv2/core/mat.hpp>
#include <optional>

#include "image/binary_descriptor.h"

namespace soslam {

// FREAK: Alahi, Ortiz and Vandergheynst, "FREAK: Fast retina keypoint" (CVPR 2012), upright and at
// its smallest scale. One bit per pair of 43 receptive fields, which lie as in a retina: seven
// rings of six and the centre, wide and sparse outside, narrow and dense inside. Is the first field
// darker?
using FreakBits = std::bitset<512>;

// Fields of one ring have one size.
inline constexpr size_t kFreakRings = 8;
// The image smoothed to the fields' size of each ring, the outer one first, the centre last.
using FreakImage = std::array<cv::Mat, kFreakRings>;

// Smooths CV_8UC1 to CV_8UC1.
FreakImage SmoothForFreak(const cv::Mat& grey);

// The descriptor of the patch of 45 x 45 px around the pixel that contains `pixel`. `mirrored`
// negates the x offsets of the fields: see BriefDescriptor. None when the patch reaches out of the
// image.
std::optional<FreakBits> FreakDescriptor(const FreakImage& smoothed, const Eigen::Vector2d& pixel,
                                         bool mirrored);

}  // namespace soslam

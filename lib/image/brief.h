// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <bitset>
#include <opencv2/core/mat.hpp>
#include <optional>

#include "image/binary_descriptor.h"

namespace soslam {

// BRIEF: Calonder, Lepetit, Strecha and Fua, "BRIEF: Binary robust independent elementary features"
// (ECCV 2010). One bit per pair of pixels of a 31 x 31 px patch: is the first one darker?
using BriefBits = std::bitset<256>;

// Smoothing that makes single pixels comparable (Calonder et al.: sigma 2 px). CV_8UC1 to CV_8UC1.
cv::Mat SmoothForBrief(const cv::Mat& grey);

// The descriptor of the patch around the pixel that contains `pixel`. `mirrored` negates the x
// offsets of the pattern (section V-B, fig. 3(a)): its descriptor at a mirror pixel equals the
// plain one at the original pixel. None when the patch reaches out of the image.
std::optional<BriefBits> BriefDescriptor(const cv::Mat& smoothed_grey, const Eigen::Vector2d& pixel,
                                         bool mirrored);

}  // namespace soslam

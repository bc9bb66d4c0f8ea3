// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include "geometry/camera.h"
#include "geometry/distortion.h"

namespace soslam {

// Undistorts images: the result is that of a pinhole camera of the same size and intrinsics.
class ImageUndistorter {
 public:
  ImageUndistorter(const Camera& camera, const Distortion& distortion);

  // `distorted` has the camera's size; any type. Interpolates linearly. Pixels that the lens did
  // not see take the value of the nearest pixel that it saw, so that the border of the picture
  // creates no edge. Thread-safe.
  cv::Mat Undistort(const cv::Mat& distorted) const;

 private:
  cv::Mat source_x_, source_y_;  // CV_32FC1, px: source of each pixel in the distorted image
};

}  // namespace soslam

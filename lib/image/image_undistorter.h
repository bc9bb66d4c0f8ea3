// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include "geometry/camera.h"
#include "geometry/distortion.h"

namespace soslam {

// Turns images that a lens took into those of a pinhole camera with the same size and intrinsics.
class ImageUndistorter {
 public:
  ImageUndistorter(const Camera& camera, const Distortion& distortion);

  // `distorted` has the camera's size; any type. Interpolates linearly. What the lens did not see
  // takes the value of the nearest pixel that it saw, so that the border of the picture gives no
  // edge. May be called by several threads at once.
  cv::Mat Undistort(const cv::Mat& distorted) const;

 private:
  cv::Mat source_x_, source_y_;  // CV_32FC1, px: where each pixel comes from
};

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "image/image_undistorter.h"

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace soslam {

ImageUndistorter::ImageUndistorter(const Camera& camera, const Distortion& distortion) {
  const cv::Matx33d intrinsics(camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0);
  cv::initUndistortRectifyMap(intrinsics, DistortionCoefficients(distortion), cv::noArray(),
                              intrinsics, {camera.width, camera.height}, CV_32FC1, source_x_,
                              source_y_);
}

cv::Mat ImageUndistorter::Undistort(const cv::Mat& distorted) const {
  cv::Mat undistorted;
  cv::remap(distorted, undistorted, source_x_, source_y_, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return undistorted;
}

}  // namespace soslam

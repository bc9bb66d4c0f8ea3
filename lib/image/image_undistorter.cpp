// SPDX-License-Identifier: BSD-3-Clause
#include "image/image_undistorter.h"

#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>
#include <opencv2/imgproc.hpp>

namespace soslam {

ImageUndistorter::ImageUndistorter(const Camera& camera, const Distortion& distortion) {
  cv::Matx33d intrinsics;
  cv::eigen2cv(camera.Intrinsics(), intrinsics);
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

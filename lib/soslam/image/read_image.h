// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <opencv2/imgcodecs.hpp>
#include <optional>

#include "soslam/geometry/camera.h"
#include "soslam/geometry/distortion.h"
#include "soslam/geometry/image_size.h"
#include "soslam/image/image_format.h"

namespace soslam {

// Reads an image by the mode cv::IMREAD_GRAYSCALE as grey values, CV_8UC1, by cv::IMREAD_COLOR as
// blue, green and red, CV_8UC3. JPEG, PNG, WebP, BMP or TIFF; bytes after the image are ignored.
// Throws InputError when the file is missing, empty, truncated, not such an image, a RAW photo,
// several images, larger than can be processed, or not of the given size.
cv::Mat ReadImage(const std::filesystem::path& path, int mode,
                  ImageOrientation orientation = ImageOrientation::kUpright,
                  const std::optional<cv::Size>& size = std::nullopt);

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

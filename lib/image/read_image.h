// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>

namespace soslam {

// An image as grey values, CV_8UC1, in the orientation its pixels are stored in: a camera's
// intrinsics know nothing of EXIF rotations. PNG or JPEG. Throws InputError when the file is
// missing, empty, cut short, not such an image, or larger than can be processed.
cv::Mat ReadGreyImage(const std::filesystem::path& path);

// The same; also throws InputError when the image is not width x height pixels.
cv::Mat ReadGreyImage(const std::filesystem::path& path, int width, int height);

// An image in colour, CV_8UC3: blue, green, red. Otherwise as ReadGreyImage.
cv::Mat ReadColourImage(const std::filesystem::path& path);
cv::Mat ReadColourImage(const std::filesystem::path& path, int width, int height);

}  // namespace soslam

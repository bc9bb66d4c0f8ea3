// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>

#include "model/image_orientation.h"

namespace soslam {

// Reads an image as grey values, CV_8UC1. JPEG, PNG, WebP, BMP or TIFF, of the latter the first
// page; bytes after the image are ignored. Throws InputError when the file is missing, empty,
// truncated, not such an image, or larger than can be processed.
cv::Mat ReadGreyImage(const std::filesystem::path& path,
                      ImageOrientation orientation = ImageOrientation::kUpright);

// The same; also throws InputError when the image is not width x height pixels.
cv::Mat ReadGreyImage(const std::filesystem::path& path, int width, int height,
                      ImageOrientation orientation = ImageOrientation::kUpright);

// Reads an image in colour, CV_8UC3: blue, green, red. Otherwise like ReadGreyImage.
cv::Mat ReadColourImage(const std::filesystem::path& path,
                        ImageOrientation orientation = ImageOrientation::kUpright);
cv::Mat ReadColourImage(const std::filesystem::path& path, int width, int height,
                        ImageOrientation orientation = ImageOrientation::kUpright);

}  // namespace soslam

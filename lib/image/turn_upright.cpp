// SPDX-License-Identifier: BSD-3-Clause
#include "image/turn_upright.h"

#include <opencv2/core.hpp>

namespace soslam {

cv::Mat TurnUpright(const cv::Mat& stored, int exif_orientation) {
  if (exif_orientation == 1) return stored;
  const bool swaps = exif_orientation >= 5;
  const bool from_the_right = exif_orientation == 2 || exif_orientation == 3 ||
                              exif_orientation == 6 || exif_orientation == 7;
  const bool from_the_bottom = exif_orientation == 3 || exif_orientation == 4 ||
                               exif_orientation == 7 || exif_orientation == 8;
  cv::Mat image = swaps ? cv::Mat(stored.t()) : stored.clone();
  if (from_the_right) cv::flip(image, image, 1);
  if (from_the_bottom) cv::flip(image, image, 0);
  return image;
}

}  // namespace soslam

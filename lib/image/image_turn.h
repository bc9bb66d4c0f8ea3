// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

namespace soslam {

// How a stored image is turned upright: its axes are exchanged, then it is mirrored.
struct ImageTurn {
  bool swaps_axes = false;
  bool mirrors_x = false;
  bool mirrors_y = false;
};

// May share the pixels of `stored` and change them.
inline cv::Mat Turned(const cv::Mat& stored, const ImageTurn& turn) {
  constexpr int kAboutX = 0, kAboutY = 1;
  cv::Mat image = turn.swaps_axes ? cv::Mat(stored.t()) : stored;
  if (turn.mirrors_x) cv::flip(image, image, kAboutY);
  if (turn.mirrors_y) cv::flip(image, image, kAboutX);
  return image;
}

}  // namespace soslam

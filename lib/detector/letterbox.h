// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include "geometry/box.h"

namespace soslam {

// How an image is fitted into the fixed input of a network without changing its proportions: scaled
// as far as it fits, centred, the rest grey.
class Letterbox {
 public:
  Letterbox(const cv::Size& image, const cv::Size& input);

  // `image` has the size that was given, CV_8UC3; the result that of the network's input.
  cv::Mat Fit(const cv::Mat& image) const;

  // A box in pixels of the network's input, measured from its outer corner, as pixels of the image,
  // cut at its border.
  Box ToImage(const Box& box_in_input) const;

 private:
  cv::Size image_;
  cv::Size input_;
  cv::Rect filled_;  // the part of the input that the image fills
};

}  // namespace soslam

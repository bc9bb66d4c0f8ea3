// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include "geometry/box.h"

namespace soslam {

// Fits an image into the fixed input of a network without changing its proportions: scaled to the
// largest size that fits, centred, and padded with grey.
class Letterbox {
 public:
  Letterbox(const cv::Size& image, const cv::Size& input);

  // `image` is CV_8UC3 of the size given above; the result has the size of the network's input.
  cv::Mat Fit(const cv::Mat& image) const;

  // Converts a box from pixels of the network's input, measured from its outer corner, to pixels of
  // the image, cut at its border.
  Box ToImage(const Box& box_in_input) const;

 private:
  cv::Size image_;
  cv::Size input_;
  cv::Rect filled_;  // the part of the input that the image fills
};

}  // namespace soslam

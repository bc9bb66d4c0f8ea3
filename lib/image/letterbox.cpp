// SPDX-License-Identifier: BSD-3-Clause
#include "image/letterbox.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace soslam {
namespace {

// One axis: from the input to the image, where the first pixel's centre is 0.
double ToImageAxis(double in_input, int start, int filled, int image) {
  const double from_corner = (in_input - start) * image / filled;
  return std::clamp(from_corner, 0.0, static_cast<double>(image)) - 0.5;
}

}  // namespace

Letterbox::Letterbox(const cv::Size& image, const cv::Size& input) : image_(image), input_(input) {
  const double scale = std::min(static_cast<double>(input.width) / image.width,
                                static_cast<double>(input.height) / image.height);
  const auto scaled = [&](int side) {
    return std::max(1, static_cast<int>(std::lround(scale * side)));
  };
  const cv::Size size(scaled(image.width), scaled(image.height));
  filled_ = {{(input.width - size.width) / 2, (input.height - size.height) / 2}, size};
}

cv::Mat Letterbox::Fit(const cv::Mat& image) const {
  constexpr int kGrey = 114;  // padding in the training of YOLO networks
  cv::Mat fitted(input_, CV_8UC3, cv::Scalar::all(kGrey));
  cv::Mat part = fitted(filled_);
  cv::resize(image, part, filled_.size(), 0.0, 0.0, cv::INTER_LINEAR);
  return fitted;
}

Box Letterbox::ToImage(const Box& box) const {
  return {ToImageAxis(box.x_min, filled_.x, filled_.width, image_.width),
          ToImageAxis(box.y_min, filled_.y, filled_.height, image_.height),
          ToImageAxis(box.x_max, filled_.x, filled_.width, image_.width),
          ToImageAxis(box.y_max, filled_.y, filled_.height, image_.height)};
}

}  // namespace soslam

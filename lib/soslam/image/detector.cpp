// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/image/detector.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "soslam/base/error.h"

namespace soslam {

Letterbox::Letterbox(const cv::Size& image, const cv::Size& input, bool is_stretched)
    : image_(image), input_(input), filled_({0, 0}, input) {
  if (is_stretched) return;
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
  // One axis: from the input to the image, where the first pixel's centre is 0.
  const auto to_image = [](double in_input, int start, int filled, int image) {
    const double from_corner = (in_input - start) * image / filled;
    return std::clamp(from_corner, 0.0, static_cast<double>(image)) - 0.5;
  };
  return {to_image(box.x_min, filled_.x, filled_.width, image_.width),
          to_image(box.y_min, filled_.y, filled_.height, image_.height),
          to_image(box.x_max, filled_.x, filled_.width, image_.width),
          to_image(box.y_max, filled_.y, filled_.height, image_.height)};
}

Detector::Detector(const NetworkFile& file, const NetworkFormat& format, std::vector<int> groups,
                   const DetectorOptions& options)
    : name_(file.name),
      network_(LoadNetwork(file)),
      format_(format),
      groups_(std::move(groups)),
      options_(options) {}

std::vector<NetworkDetection> Detector::Detect(const cv::Mat& image) {
  const LayoutProperties layout = PropertiesOf(format_.layout);
  const Letterbox letterbox(image.size(), format_.input, layout.is_for_stretched);
  const auto outputs = network_->Forward(letterbox.Fit(image), format_.pixel_values);
  auto found = ReadNetworkOutput(outputs, format_, options_.min_score, name_);
  if (layout.may_overlap) found = WithoutOverlaps(found, groups_, options_.max_overlap);
  std::vector<NetworkDetection> detections;
  for (NetworkDetection detection : found) {
    const bool is_tiny = std::max(detection.box.Width(), detection.box.Height()) < kTinySide;
    detection.box = letterbox.ToImage(detection.box);
    const bool is_outside = detection.box.Width() <= 0.0 || detection.box.Height() <= 0.0;
    tally_ += {1, is_tiny ? 1 : 0, is_outside && !is_tiny ? 1 : 0};
    if (!is_outside) detections.push_back(detection);
  }
  return detections;
}

void CheckBoxesArePossible(const BoxTally& tally, const NetworkFormat& format,
                           const std::string& network) {
  constexpr double kMostImpossible = 0.9;
  if (tally.tiny + tally.outside <= kMostImpossible * tally.boxes) return;
  throw InputError(fmt::format(
      "{}: of {} boxes {} are smaller than {} pixels of the input and {} others are outside of the "
      "image; expected boxes of objects. Taken for {}: another layout or other pixel values are "
      "likely (output_layout, pixel_values)",
      network, tally.boxes, tally.tiny, kTinySide, tally.outside, format.Text()));
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "image/sample_bilinear.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace soslam {
namespace {

template <typename Scalar>
std::optional<Sample> SampleTyped(const cv::Mat& map, const Eigen::Vector2d& pixel) {
  const int x = std::min(static_cast<int>(pixel.x()), map.cols - 2);
  const int y = std::min(static_cast<int>(pixel.y()), map.rows - 2);
  const Scalar* above = map.ptr<Scalar>(y) + x;
  const Scalar* below = map.ptr<Scalar>(y + 1) + x;
  const double dx = pixel.x() - x;
  const double dy = pixel.y() - y;
  const double top_left = above[0], top_right = above[1];
  const double bottom_left = below[0], bottom_right = below[1];
  const double top = (1.0 - dx) * top_left + dx * top_right;
  const double bottom = (1.0 - dx) * bottom_left + dx * bottom_right;
  const Sample sample{
      (1.0 - dy) * top + dy * bottom,
      {(1.0 - dy) * (top_right - top_left) + dy * (bottom_right - bottom_left), bottom - top}};
  if (!std::isfinite(sample.value)) return std::nullopt;  // as where any of the four is not
  return sample;
}

}  // namespace

bool IsBetweenPixelCentres(const cv::Mat& map, const Eigen::Vector2d& pixel) {  // false for NaN
  return map.cols >= 2 && map.rows >= 2 &&                                      //
         pixel.x() >= 0.0 && pixel.x() <= map.cols - 1.0 &&                     //
         pixel.y() >= 0.0 && pixel.y() <= map.rows - 1.0;
}

std::optional<Sample> SampleBilinear(const cv::Mat& map, const Eigen::Vector2d& pixel) {
  CV_Assert(map.type() == CV_8UC1 || map.type() == CV_32FC1);
  if (!IsBetweenPixelCentres(map, pixel)) return std::nullopt;
  return map.type() == CV_8UC1 ? SampleTyped<std::uint8_t>(map, pixel)
                               : SampleTyped<float>(map, pixel);
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "image/sample_bilinear.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/wide_loops.h"
#include "image/sample_batch.h"

namespace soslam {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

template <typename Scalar>
std::optional<Sample> SampleTyped(const cv::Mat& map, const Eigen::Vector2d& pixel) {
  const int x = std::min(static_cast<int>(pixel.x()), map.cols - 2);
  const int y = std::min(static_cast<int>(pixel.y()), map.rows - 2);
  const double dx = pixel.x() - x;
  const double dy = pixel.y() - y;
  const double top_left = map.at<Scalar>(y, x);
  const double top_right = map.at<Scalar>(y, x + 1);
  const double bottom_left = map.at<Scalar>(y + 1, x);
  const double bottom_right = map.at<Scalar>(y + 1, x + 1);
  const double top = (1.0 - dx) * top_left + dx * top_right;
  const double bottom = (1.0 - dx) * bottom_left + dx * bottom_right;
  const Sample sample{
      (1.0 - dy) * top + dy * bottom,
      {(1.0 - dy) * (top_right - top_left) + dy * (bottom_right - bottom_left), bottom - top}};
  if (!std::isfinite(sample.value) || !sample.gradient.allFinite()) return std::nullopt;
  return sample;
}

template <typename Scalar>
SOSLAM_FORCE_INLINE void SampleBatch(const MapView<Scalar>& map, const BatchOfPixels& pixels,
                                     Batch* values, BatchOfPixels* gradients) {
  Cells cells;
  for (int i = 0; i < kBatchSize; i += 4) {
    Four x, y;
    Load(pixels[0].data() + i, &x);
    Load(pixels[1].data() + i, &y);
    cells.Locate(map, x, y, i);
  }
  for (int i = 0; i < kBatchSize; i += 4) {
    const SampleOfFour sample(map, cells, i);
    Four value;
    sample.Interpolate(&value);
    Store(value, values->data() + i);
    if (gradients == nullptr) continue;
    Four by_x, by_y;
    sample.Differentiate(&by_x, &by_y);
    Store(by_x, (*gradients)[0].data() + i);
    Store(by_y, (*gradients)[1].data() + i);
  }
}

SOSLAM_MULTIVERSION void SampleBytes(const MapView<std::uint8_t>& map, const BatchOfPixels& pixels,
                                     Batch* values, BatchOfPixels* gradients) {
  SampleBatch(map, pixels, values, gradients);
}

SOSLAM_MULTIVERSION void SampleFloats(const MapView<float>& map, const BatchOfPixels& pixels,
                                      Batch* values, BatchOfPixels* gradients) {
  SampleBatch(map, pixels, values, gradients);
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

Batch SampleBilinear(const cv::Mat& map, const BatchOfPixels& pixels, BatchOfPixels* gradients) {
  CV_Assert(map.type() == CV_8UC1 || map.type() == CV_32FC1);
  if (map.cols < 2 || map.rows < 2) {
    if (gradients != nullptr) gradients->fill(Batch::Zero());
    return Batch::Constant(kNone);
  }
  Batch values;
  map.type() == CV_8UC1 ? SampleBytes(MapView<std::uint8_t>(map), pixels, &values, gradients)
                        : SampleFloats(MapView<float>(map), pixels, &values, gradients);
  return values;
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "image/sample_bilinear.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/wide_loops.h"

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

// Where pixels lie between the pixel centres of a map.
struct Cells {
  std::array<int, kBatchSize> top_left;  // offset of that centre in the map
  Batch dx;                              // from it
  Batch dy;
  Batch nothing_outside;  // 0 inside of the map, NaN outside
};

SOSLAM_WIDE_LOOPS void Locate(const BatchOfPixels& __restrict pixels, int columns, int rows,
                              int step, Cells* __restrict cells) {
  const double* all_x = pixels[0].data();
  const double* all_y = pixels[1].data();
  const double last_x = columns - 1.0;
  const double last_y = rows - 1.0;
  for (int i = 0; i < kBatchSize; ++i) {
    const double x = all_x[i];
    const double y = all_y[i];
    const double inside_x = x >= 0.0 && x <= last_x ? x : 0.0;
    const double inside_y = y >= 0.0 && y <= last_y ? y : 0.0;
    const int column = std::min(static_cast<int>(inside_x), columns - 2);
    const int row = std::min(static_cast<int>(inside_y), rows - 2);
    cells->dx[i] = inside_x - column;
    cells->dy[i] = inside_y - row;
    cells->nothing_outside[i] = (inside_x == x ? 0.0 : kNone) + (inside_y == y ? 0.0 : kNone);
    cells->top_left[static_cast<size_t>(i)] = row * step + column;
  }
}

// The map at the four pixel centres around: top left, top right, bottom left, bottom right.
using Corners = std::array<Batch, 4>;

template <typename Scalar>
void Gather(const cv::Mat& map, const Cells& cells, Corners* corners) {
  const auto* values = map.ptr<Scalar>();
  const size_t step = map.step1();
  for (int i = 0; i < kBatchSize; ++i) {
    const Scalar* corner = values + cells.top_left[static_cast<size_t>(i)];
    (*corners)[0][i] = corner[0];
    (*corners)[1][i] = corner[1];
    (*corners)[2][i] = corner[step];
    (*corners)[3][i] = corner[step + 1];
  }
}

SOSLAM_WIDE_LOOPS void Interpolate(const Corners& corners, const Cells& cells, Batch* values) {
  for (int i = 0; i < kBatchSize; ++i) {
    const double dx = cells.dx[i];
    const double dy = cells.dy[i];
    const double top = (1.0 - dx) * corners[0][i] + dx * corners[1][i];
    const double bottom = (1.0 - dx) * corners[2][i] + dx * corners[3][i];
    (*values)[i] = (1.0 - dy) * top + dy * bottom + cells.nothing_outside[i];
  }
}

SOSLAM_WIDE_LOOPS void Differentiate(const Corners& corners, const Cells& cells,
                                     BatchOfPixels* gradients) {
  for (int i = 0; i < kBatchSize; ++i) {
    const double dx = cells.dx[i];
    const double dy = cells.dy[i];
    const double by_x = (1.0 - dy) * (corners[1][i] - corners[0][i]) +  //
                        dy * (corners[3][i] - corners[2][i]);
    const double by_y = (1.0 - dx) * (corners[2][i] - corners[0][i]) +  //
                        dx * (corners[3][i] - corners[1][i]);
    // x - x is NaN for what is infinite or NaN.
    const double zero_if_finite = (by_x - by_x) + (by_y - by_y) + cells.nothing_outside[i];
    (*gradients)[0][i] = zero_if_finite == 0.0 ? by_x : 0.0;
    (*gradients)[1][i] = zero_if_finite == 0.0 ? by_y : 0.0;
  }
}

}  // namespace

bool IsBetweenPixelCentres(const cv::Mat& map, const Eigen::Vector2d& pixel) {  // not so of NaN
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
  Cells cells;
  Locate(pixels, map.cols, map.rows, static_cast<int>(map.step1()), &cells);
  Corners corners;
  map.type() == CV_8UC1 ? Gather<std::uint8_t>(map, cells, &corners)
                        : Gather<float>(map, cells, &corners);
  Batch values;
  Interpolate(corners, cells, &values);
  if (gradients != nullptr) Differentiate(corners, cells, gradients);
  return values;
}

}  // namespace soslam

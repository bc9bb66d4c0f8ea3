// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <opencv2/core/mat.hpp>

#include "base/wide_loops.h"
#include "geometry/batch.h"

namespace soslam {

// View of a map whose values are stored row by row.
template <typename Scalar>
struct MapView {
  // The map has at least 2 x 2 pixels and must outlive the view.
  explicit MapView(const cv::Mat& map)
      : values(map.ptr<Scalar>()),
        step(static_cast<int>(map.step1())),
        columns(map.cols),
        rows(map.rows) {}

  const Scalar* values;
  int step;  // number of elements from row to row
  int columns;
  int rows;
};

using FourIntegers [[gnu::vector_size(4 * sizeof(int))]] = int;

// Element by element: GCC 12 would convert a vector of integers in halves.
SOSLAM_FORCE_INLINE void Convert(const FourIntegers& from, Four* to) {
  *to = Four{static_cast<double>(from[0]), static_cast<double>(from[1]),
             static_cast<double>(from[2]), static_cast<double>(from[3])};
}

// Position of each pixel of a batch between the pixel centres of a map. All pixels are located
// before any is looked up: alternating would make the processor wait for each lookup.
struct alignas(kFourAlignment) Cells {
  // Locates the pixels from number i on.
  template <typename Scalar>
  SOSLAM_FORCE_INLINE void Locate(const MapView<Scalar>& map, const Four& x, const Four& y,
                                  size_t i) {
    const Four last_x = Four{} + (map.columns - 1.0);
    const Four last_y = Four{} + (map.rows - 1.0);
    Four inside_x = x > 0.0 ? x : Four{};  // also for NaN
    Four inside_y = y > 0.0 ? y : Four{};
    inside_x = inside_x < last_x ? inside_x : last_x;
    inside_y = inside_y < last_y ? inside_y : last_y;
    const FourMask is_inside = (inside_x == x) & (inside_y == y);
    const FourIntegers last_column = FourIntegers{} + (map.columns - 2);
    const FourIntegers last_row = FourIntegers{} + (map.rows - 2);
    FourIntegers column = __builtin_convertvector(inside_x, FourIntegers);
    FourIntegers row = __builtin_convertvector(inside_y, FourIntegers);
    column = column < last_column ? column : last_column;
    row = row < last_row ? row : last_row;
    top_left[i / 4] = row * map.step + column;
    Four left, top;
    Convert(column, &left);
    Convert(row, &top);
    dx[i / 4] = is_inside ? x - left : Four{} + std::numeric_limits<double>::quiet_NaN();
    dy[i / 4] = inside_y - top;
  }

  std::array<Four, kBatchSize / 4> dx;  // from the centre to the top left, px; NaN outside the map
  std::array<Four, kBatchSize / 4> dy;
  std::array<FourIntegers, kBatchSize / 4> top_left;  // offset of that centre in the map
};

// Map values at the four pixel centres around each of four pixels.
struct FourCorners {
  Four top_left, top_right, bottom_left, bottom_right;
};

// Loads horizontal neighbours in pairs and converts them in SIMD registers.
SOSLAM_FORCE_INLINE void LoadPairs(const float* row, const FourIntegers& at, Four* left,
                                   Four* right) {
  using FourPairs [[gnu::vector_size(4 * sizeof(std::int64_t))]] = std::int64_t;
  using EightFloats [[gnu::vector_size(8 * sizeof(float))]] = float;
  using Eight [[gnu::vector_size(8 * sizeof(double))]] = double;
  const auto pair = [&](size_t k) {
    std::int64_t bits = 0;
    std::memcpy(&bits, row + at[k], sizeof(bits));
    return bits;
  };
  const FourPairs pairs = {pair(0), pair(2), pair(1), pair(3)};
  EightFloats floats;
  std::memcpy(&floats, &pairs, sizeof(floats));
  const Eight numbers = __builtin_convertvector(floats, Eight);
  std::array<Four, 2> halves;
  std::memcpy(&halves, &numbers, sizeof(halves));
  *left = __builtin_shufflevector(halves[0], halves[1], 0, 4, 2, 6);
  *right = __builtin_shufflevector(halves[0], halves[1], 1, 5, 3, 7);
}

SOSLAM_FORCE_INLINE void LoadCorners(const MapView<float>& map, const FourIntegers& top_left,
                                     FourCorners* corners) {
  LoadPairs(map.values, top_left, &corners->top_left, &corners->top_right);
  LoadPairs(map.values + map.step, top_left, &corners->bottom_left, &corners->bottom_right);
}

SOSLAM_FORCE_INLINE void LoadCorners(const MapView<std::uint8_t>& map, const FourIntegers& top_left,
                                     FourCorners* corners) {
  const auto bytes = [&](size_t k) {
    const std::uint8_t* corner = map.values + top_left[k];
    std::uint16_t top = 0, bottom = 0;
    std::memcpy(&top, corner, sizeof(top));
    std::memcpy(&bottom, corner + map.step, sizeof(bottom));
    return static_cast<int>(top | std::uint32_t{bottom} << 16);
  };
  const FourIntegers four = {bytes(0), bytes(1), bytes(2), bytes(3)};
  Convert(four & 255, &corners->top_left);
  Convert(four >> 8 & 255, &corners->top_right);
  Convert(four >> 16 & 255, &corners->bottom_left);
  Convert(four >> 24 & 255, &corners->bottom_right);
}

// SampleBilinear at four pixels.
struct SampleOfFour {
  // Takes the four pixels of a batch from number i on.
  template <typename Scalar>
  SOSLAM_FORCE_INLINE SampleOfFour(const MapView<Scalar>& map, const Cells& cells, size_t i)
      : dx(cells.dx[i / 4]), dy(cells.dy[i / 4]) {
    LoadCorners(map, cells.top_left[i / 4], &corners);
  }

  // NaN or infinite where the map has no value.
  SOSLAM_FORCE_INLINE void Interpolate(Four* value) const {
    const Four top = (1.0 - dx) * corners.top_left + dx * corners.top_right;
    const Four bottom = (1.0 - dx) * corners.bottom_left + dx * corners.bottom_right;
    *value = (1.0 - dy) * top + dy * bottom;
  }

  // Derivatives by x and y; 0 where the map has no value.
  SOSLAM_FORCE_INLINE void Differentiate(Four* by_x, Four* by_y) const {
    const Four x = (1.0 - dy) * (corners.top_right - corners.top_left) +
                   dy * (corners.bottom_right - corners.bottom_left);
    const Four y = (1.0 - dx) * (corners.bottom_left - corners.top_left) +
                   dx * (corners.bottom_right - corners.top_right);
    // x - x is NaN if x is infinite or NaN.
    const FourMask is_known = (x - x) + (y - y) == 0.0;
    *by_x = is_known ? x : Four{};
    *by_y = is_known ? y : Four{};
  }

  FourCorners corners;
  Four dx, dy;
};

}  // namespace soslam

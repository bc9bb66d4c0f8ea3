// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstring>
#include <limits>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "base/simd.h"
#include "geometry/batch.h"

namespace soslam {

// Smallest and largest coordinates of a set of pixels.
struct PixelBounds {
  float least_x, least_y, largest_x, largest_y;
};

// The part of a map that is looked up, in single precision: pixels are off by 1e-7 of the map's
// size, which suffices for costs that are only compared and not differentiated. Each pixel is
// followed in memory by the one below it, so that the four around a point are loaded at once.
class Neighbours {
 public:
  // The map is CV_32FC1 with at least 2 x 2 pixels.
  explicit Neighbours(const cv::Mat& map) : map_(map) {
    CV_Assert(map.type() == CV_32FC1 && map.cols >= 2 && map.rows >= 2);
  }

  // Prepares the part of the map within the bounds; to be called before lookups there.
  void SelectInBounds(const PixelBounds& bounds);
  // True if the bounds are inside the map, rounding errors included.
  bool AreInside(const PixelBounds& bounds) const;

  struct View {
    const float* values;  // each pixel followed by the one below it, from the top left of the part
    cv::Rect part;        // within the map, last pixels included
  };
  View view() const { return {values_.data(), part_}; }

 private:
  cv::Mat map_;
  cv::Rect part_;
  std::vector<float> values_;
};

// Position of each pixel of a batch between the pixel centres of a map. All pixels are located
// before any is looked up: alternating would make the processor wait for each lookup.
struct CellsOfEight {
  static constexpr size_t kCount = kBatchSize / 8;

  // Locates eight pixels, the i-th eight of the batch. Pixels outside the part count as outside the
  // map; unless `may_be_outside`, the caller guarantees that there are none.
  template <bool may_be_outside>
  SOSLAM_FORCE_INLINE void Locate(const Neighbours::View& view, const Eight& x, const Eight& y,
                                  size_t i) {
    Eight inside_x = x, inside_y = y;
    if constexpr (may_be_outside) {
      const Eight left = Eight{} + static_cast<float>(view.part.x);
      const Eight top = Eight{} + static_cast<float>(view.part.y);
      const Eight right = left + static_cast<float>(view.part.width - 1);
      const Eight bottom = top + static_cast<float>(view.part.height - 1);
      inside_x = x > left ? x : left;  // also for NaN
      inside_y = y > top ? y : top;
      inside_x = inside_x < right ? inside_x : right;
      inside_y = inside_y < bottom ? inside_y : bottom;
    }
    EightIntegers column = __builtin_convertvector(inside_x, EightIntegers);
    EightIntegers row = __builtin_convertvector(inside_y, EightIntegers);
    if constexpr (may_be_outside) {
      const EightIntegers last_column = EightIntegers{} + (view.part.x + view.part.width - 2);
      const EightIntegers last_row = EightIntegers{} + (view.part.y + view.part.height - 2);
      column = column < last_column ? column : last_column;
      row = row < last_row ? row : last_row;
    }
    top_left[i] = row * view.part.width + column - (view.part.y * view.part.width + view.part.x);
    dx[i] = x - __builtin_convertvector(column, Eight);
    dy[i] = y - __builtin_convertvector(row, Eight);
    if constexpr (may_be_outside) {
      const EightMask is_inside = (inside_x == x) & (inside_y == y);
      dx[i] = is_inside ? dx[i] : Eight{} + std::numeric_limits<float>::quiet_NaN();
    }
  }

  std::array<Eight, kCount> dx;  // from the centre to the top left, px; NaN outside the map
  std::array<Eight, kCount> dy;
  std::array<EightIntegers, kCount> top_left;  // index of that centre in the part
};

// Bilinear interpolation at the i-th eight pixels: NaN or infinite where the map has no value.
SOSLAM_FORCE_INLINE void Interpolate(const Neighbours::View& view, const CellsOfEight& cells,
                                     size_t i, Eight* value) {
  using FourFloats [[gnu::vector_size(4 * sizeof(float))]] = float;
  // Values around the k-th and the (k + 4)-th pixel: top left, bottom left, top right, bottom
  // right.
  const auto load = [&](size_t k, Eight* two) {
    FourFloats one, other;
    std::memcpy(&one, view.values + 2 * std::ptrdiff_t{cells.top_left[i][k]}, sizeof(one));
    std::memcpy(&other, view.values + 2 * std::ptrdiff_t{cells.top_left[i][k + 4]}, sizeof(other));
    *two = __builtin_shufflevector(one, other, 0, 1, 2, 3, 4, 5, 6, 7);
  };
  Eight a, b, c, d;
  load(0, &a);
  load(1, &b);
  load(2, &c);
  load(3, &d);
  const Eight left_ab = __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13);
  const Eight left_cd = __builtin_shufflevector(c, d, 0, 8, 1, 9, 4, 12, 5, 13);
  const Eight right_ab = __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15);
  const Eight right_cd = __builtin_shufflevector(c, d, 2, 10, 3, 11, 6, 14, 7, 15);
  const Eight top_left = __builtin_shufflevector(left_ab, left_cd, 0, 1, 8, 9, 4, 5, 12, 13);
  const Eight bottom_left = __builtin_shufflevector(left_ab, left_cd, 2, 3, 10, 11, 6, 7, 14, 15);
  const Eight top_right = __builtin_shufflevector(right_ab, right_cd, 0, 1, 8, 9, 4, 5, 12, 13);
  const Eight bottom_right =
      __builtin_shufflevector(right_ab, right_cd, 2, 3, 10, 11, 6, 7, 14, 15);
  const Eight top = top_left + cells.dx[i] * (top_right - top_left);
  const Eight bottom = bottom_left + cells.dx[i] * (bottom_right - bottom_left);
  *value = top + cells.dy[i] * (bottom - top);
}

}  // namespace soslam

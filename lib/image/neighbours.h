// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstring>
#include <limits>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "base/wide_loops.h"
#include "geometry/batch.h"

namespace soslam {

// Pixels from the least to the largest.
struct PixelBounds {
  float least_x, least_y, largest_x, largest_y;
};

// The part of a map that is looked up, in single precision: pixels are off by 1e-7 of the map's
// size, which is for costs that are only compared, and have no derivatives. Each pixel has the one
// below it as its neighbour in memory, so that the four around a point are loaded at once.
class Neighbours {
 public:
  // CV_32FC1, of at least 2 x 2 pixels.
  explicit Neighbours(const cv::Mat& map) : map_(map) {
    CV_Assert(map.type() == CV_32FC1 && map.cols >= 2 && map.rows >= 2);
  }

  // Before what lies there is looked up.
  void Cover(const PixelBounds& bounds);
  // Whether what lies there is in the map with all that rounding may do to it.
  bool AreInside(const PixelBounds& bounds) const;

  struct View {
    const float* values;  // from the top left of the part: pixels and those below them in turn
    cv::Rect part;        // of the map, to its last pixels
  };
  View view() const { return {values_.data(), part_}; }

 private:
  cv::Mat map_;
  cv::Rect part_;
  std::vector<float> values_;
};

// Where the pixels of a batch lie between the pixel centres of a map, as Cells of sample_batch.h.
struct CellsOfEight {
  static constexpr size_t kCount = kBatchSize / 8;

  // Eight pixels, the i-th ones of the batch. Those outside of the part are outside of the map;
  // there are none unless `may_be_outside`.
  template <bool may_be_outside>
  SOSLAM_IN_WIDE_LOOPS void Locate(const Neighbours::View& view, const Eight& x, const Eight& y,
                                   size_t i) {
    Eight inside_x = x, inside_y = y;
    if constexpr (may_be_outside) {
      const Eight left = Eight{} + static_cast<float>(view.part.x);
      const Eight top = Eight{} + static_cast<float>(view.part.y);
      const Eight right = left + static_cast<float>(view.part.width - 1);
      const Eight bottom = top + static_cast<float>(view.part.height - 1);
      inside_x = x > left ? x : left;  // so of NaN
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

  std::array<Eight, kCount> dx;  // from the centre to the top left; NaN outside of the map
  std::array<Eight, kCount> dy;
  std::array<EightIntegers, kCount> top_left;  // how many pixels into the part that centre is
};

// What is between the pixel centres around the i-th eight pixels: NaN or infinite where there is
// nothing.
SOSLAM_IN_WIDE_LOOPS void Interpolate(const Neighbours::View& view, const CellsOfEight& cells,
                                      size_t i, Eight* value) {
  using FourFloats [[gnu::vector_size(4 * sizeof(float))]] = float;
  // Of the k-th pixel and of the one four further on: left and the one below, right and below.
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

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include "base/wide_loops.h"
#include "geometry/batch.h"
#include "image/sample_batch.h"

namespace soslam {

// As Cells of sample_batch.h, eight side by side in single precision: pixels are off by 1e-7 of the
// map's size, which is for costs that are only compared, and have no derivatives.
struct CellsOfEight {
  static constexpr size_t kCount = kBatchSize / 8;

  // Eight pixels, the i-th ones of the batch.
  SOSLAM_IN_WIDE_LOOPS void Locate(const MapView<float>& map, const Eight& x, const Eight& y,
                                   size_t i) {
    const Eight last_x = Eight{} + static_cast<float>(map.columns - 1);
    const Eight last_y = Eight{} + static_cast<float>(map.rows - 1);
    Eight inside_x = x > 0.0F ? x : Eight{};  // so of NaN
    Eight inside_y = y > 0.0F ? y : Eight{};
    inside_x = inside_x < last_x ? inside_x : last_x;
    inside_y = inside_y < last_y ? inside_y : last_y;
    const EightMask is_inside = (inside_x == x) & (inside_y == y);
    const EightIntegers last_column = EightIntegers{} + (map.columns - 2);
    const EightIntegers last_row = EightIntegers{} + (map.rows - 2);
    EightIntegers column = __builtin_convertvector(inside_x, EightIntegers);
    EightIntegers row = __builtin_convertvector(inside_y, EightIntegers);
    column = column < last_column ? column : last_column;
    row = row < last_row ? row : last_row;
    top_left[i] = row * map.step + column;
    const Eight from_left = x - __builtin_convertvector(column, Eight);
    dx[i] = is_inside ? from_left : Eight{} + std::numeric_limits<float>::quiet_NaN();
    dy[i] = inside_y - __builtin_convertvector(row, Eight);
  }

  std::array<Eight, kCount> dx;  // from the centre to the top left; NaN outside of the map
  std::array<Eight, kCount> dy;
  std::array<EightIntegers, kCount> top_left;  // offset of that centre in the map
};

// Neighbours of a row are loaded together.
SOSLAM_IN_WIDE_LOOPS void LoadPairs(const float* row, const EightIntegers& at, Eight* left,
                                    Eight* right) {
  using FourPairs [[gnu::vector_size(4 * sizeof(std::int64_t))]] = std::int64_t;
  const auto pair = [&](size_t k) {
    std::int64_t bits = 0;
    std::memcpy(&bits, row + at[k], sizeof(bits));
    return bits;
  };
  const std::array<FourPairs, 2> pairs = {FourPairs{pair(0), pair(1), pair(4), pair(5)},
                                          FourPairs{pair(2), pair(3), pair(6), pair(7)}};
  std::array<Eight, 2> values;
  std::memcpy(&values, &pairs, sizeof(values));
  *left = __builtin_shufflevector(values[0], values[1], 0, 2, 8, 10, 4, 6, 12, 14);
  *right = __builtin_shufflevector(values[0], values[1], 1, 3, 9, 11, 5, 7, 13, 15);
}

// A map between the pixel centres around the i-th eight pixels: NaN or infinite where there is
// none.
SOSLAM_IN_WIDE_LOOPS void Interpolate(const MapView<float>& map, const CellsOfEight& cells,
                                      size_t i, Eight* value) {
  Eight top_left, top_right, bottom_left, bottom_right;
  LoadPairs(map.values, cells.top_left[i], &top_left, &top_right);
  LoadPairs(map.values + map.step, cells.top_left[i], &bottom_left, &bottom_right);
  const Eight top = top_left + cells.dx[i] * (top_right - top_left);
  const Eight bottom = bottom_left + cells.dx[i] * (bottom_right - bottom_left);
  *value = top + cells.dy[i] * (bottom - top);
}

}  // namespace soslam

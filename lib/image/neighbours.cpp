// SPDX-License-Identifier: BSD-3-Clause
#include "image/neighbours.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace soslam {
namespace {

// First and last index from the pixel centre before `least` to that after `largest`, both within 0
// to size - 1 and at least two indices. Without bounds (NaN, or largest < least) the whole axis.
std::array<int, 2> Range(float least, float largest, int size) {
  const float last = static_cast<float>(size - 1);
  if (!(least <= largest)) return {0, size - 1};
  const int from = static_cast<int>(std::floor(std::clamp(least, 0.0F, last)));
  const int to = static_cast<int>(std::ceil(std::clamp(largest, 0.0F, last)));
  return {std::min(from, size - 2), std::max(to, std::min(from, size - 2) + 1)};
}

cv::Rect Part(const PixelBounds& bounds, float margin, const cv::Mat& map) {
  const auto [left, right] = Range(bounds.least_x - margin, bounds.largest_x + margin, map.cols);
  const auto [top, bottom] = Range(bounds.least_y - margin, bounds.largest_y + margin, map.rows);
  return {left, top, right - left + 1, bottom - top + 1};
}

}  // namespace

void Neighbours::SelectInBounds(const PixelBounds& bounds) {
  // Margins in pixels: for rounding errors, and to cover the next lookups as well.
  constexpr float kRounding = 1.0F, kMargin = 24.0F;
  const cv::Rect needed = Part(bounds, kRounding, map_);
  if ((needed & part_) == needed) return;
  part_ |= Part(bounds, kMargin, map_);
  values_.resize(2 * static_cast<size_t>(part_.width) * static_cast<size_t>(part_.height - 1));
  float* to = values_.data();
  for (int row = 0; row + 1 < part_.height; ++row) {
    const float* above = map_.ptr<float>(part_.y + row) + part_.x;
    const float* below = map_.ptr<float>(part_.y + row + 1) + part_.x;
    for (int column = 0; column < part_.width; ++column) {
      *to++ = above[column];
      *to++ = below[column];
    }
  }
}

bool Neighbours::AreInside(const PixelBounds& bounds) const {
  constexpr float kRounding = 0.01F;
  const bool are_any = bounds.least_x <= bounds.largest_x && bounds.least_y <= bounds.largest_y;
  return are_any && bounds.least_x >= kRounding && bounds.least_y >= kRounding &&
         bounds.largest_x <= static_cast<float>(map_.cols - 1) - kRounding &&
         bounds.largest_y <= static_cast<float>(map_.rows - 1) - kRounding;
}

}  // namespace soslam

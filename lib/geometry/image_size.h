// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace soslam {

// More pixels than cameras have; a larger size is damaged, or made to exhaust the memory.
inline constexpr std::int64_t kMaxPixels = std::int64_t{1} << 27;

// True if an image can have this many columns and rows.
inline bool IsImageSize(std::int64_t width, std::int64_t height) {
  return width > 0 && height > 0 && width <= kMaxPixels / height;
}

}  // namespace soslam

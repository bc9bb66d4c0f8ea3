// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace soslam {

// Orientation of the image that a camera and boxes refer to, where an image file has an EXIF
// orientation: as viewers show the image, or as the file stores it.
enum class ImageOrientation { kUpright, kStored };
inline constexpr std::array kImageOrientationNames = {"upright", "stored"};
inline constexpr const auto& NamesOf(ImageOrientation) { return kImageOrientationNames; }

// More pixels than cameras have; a larger size is damaged, or made to exhaust the memory.
inline constexpr std::int64_t kMaxPixels = std::int64_t{1} << 27;

// True if an image can have this many columns and rows.
inline bool IsImageSize(std::int64_t width, std::int64_t height) {
  return width > 0 && height > 0 && width <= kMaxPixels / height;
}

// IsImageSize for numbers of a text, which may have decimals.
inline bool IsWholeImageSize(double width, double height) {
  const auto is_whole = [](double number) {
    return number > 0.0 && number <= static_cast<double>(kMaxPixels) &&
           number == std::floor(number);
  };
  return is_whole(width) && is_whole(height) &&
         IsImageSize(static_cast<std::int64_t>(width), static_cast<std::int64_t>(height));
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "model/image_orientation.h"

namespace soslam {

struct ImageSize {
  std::int64_t width = 0;
  std::int64_t height = 0;
};

// Properties that an image file states before any pixel is decoded.
struct ImageHeader {
  ImageSize stored;     // size of the pixels that the file stores
  int orientation = 1;  // EXIF's, 1 to 8: 1 upright, 3 upside down, 5 to 8 turned by a quarter

  bool IsTurnedByAQuarter() const { return orientation >= 5; }
  // The size of the image when it is read with this setting.
  ImageSize Size(ImageOrientation read_as) const {
    const bool swaps = read_as == ImageOrientation::kUpright && IsTurnedByAQuarter();
    return swaps ? ImageSize{stored.height, stored.width} : stored;
  }
};

// Reads only the necessary part of the file, usually a few hundred bytes. None for a file that
// cannot be opened, has none of the formats of image_format.h, or ends before its size.
std::optional<ImageHeader> ReadImageHeader(const std::filesystem::path& path);

}  // namespace soslam

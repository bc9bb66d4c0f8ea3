// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace soslam {

// Orientation of the image that a camera and boxes refer to, where an image file has an EXIF
// orientation: as viewers show the image, or as the file stores it.
enum class ImageOrientation { kUpright, kStored };
inline constexpr const char* kImageOrientationNames[] = {"upright", "stored"};

}  // namespace soslam

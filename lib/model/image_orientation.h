// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace soslam {

// Which pixels a camera and boxes refer to where an image file has a note of EXIF that turns it:
// those of the image as viewers show it, or those that the file stores.
enum class ImageOrientation { kUpright, kStored };
inline constexpr const char* kImageOrientationNames[] = {"upright", "stored"};

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "image/image_format.h"

namespace soslam {

const ImageFormat* FindImageFormat(std::string_view first_bytes) {
  for (const ImageFormat* format :
       {&kJpegFormat, &kPngFormat, &kWebpFormat, &kBmpFormat, &kTiffFormat}) {
    if (format->has_signature(first_bytes)) return format;
  }
  return nullptr;
}

}  // namespace soslam

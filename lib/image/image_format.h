// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "image/image_bytes.h"
#include "image/image_header.h"

namespace soslam {

// A format of image files. OpenCV decodes more formats; some of them allocate as much memory as a
// few bytes demand, or read other files.
struct ImageFormat {
  const char* name;
  bool (*has_signature)(
      std::string_view first_bytes);  // kSignatureSize bytes, or all if the file has fewer
  // The header of a file. None if it has no size, or one that a decoder might read differently.
  std::optional<ImageHeader> (*header)(const ImageBytes& file);
  // Number of bytes that the image takes: phones and others append data of their own. None if the
  // file is truncated: decoders fill in the missing part without an error. If there is a header,
  // its size must have passed IsImageSize.
  std::optional<size_t> (*length)(std::string_view file);
  const char* whole;  // how to distinguish a complete file from a truncated one, for error messages
  // Sets the file's orientation to 1, for formats whose decoders turn images unasked; else null.
  void (*clear_orientation)(std::span<char> file) = nullptr;
};
inline constexpr size_t kSignatureSize = 12;

extern const ImageFormat kJpegFormat, kPngFormat, kWebpFormat, kBmpFormat, kTiffFormat;

// The format of a file by its first bytes; null if it is none of these.
const ImageFormat* FindImageFormat(std::string_view first_bytes);

}  // namespace soslam

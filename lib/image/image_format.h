// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "image/image_bytes.h"
#include "image/image_header.h"

namespace soslam {

// A format of image files. OpenCV decodes more of them, some of which allocate whatever a few bytes
// ask for, or have other files read.
struct ImageFormat {
  const char* name;
  bool (*has_signature)(std::string_view first_bytes);  // kSignatureSize of them, or all
  // None where there is no size, or one that a decoder might read otherwise.
  std::optional<ImageHeader> (*header)(const ImageBytes& file);
  // How many bytes the image takes, as phones and others append what they like. None where it is
  // cut short: decoders fill in what is missing, without an error. Where there is a header, its
  // size is one that images can have.
  std::optional<size_t> (*length)(std::string_view file);
  const char* whole;  // how a whole one is told from one that is cut short
  // Has the file say orientation 1, where decoders turn images without being asked; null elsewhere.
  void (*clear_orientation)(std::span<char> file) = nullptr;
};
inline constexpr size_t kSignatureSize = 12;

extern const ImageFormat kJpegFormat, kPngFormat, kWebpFormat, kBmpFormat, kTiffFormat;

// The format of a file by its first bytes; null where it is none of these.
const ImageFormat* FindImageFormat(std::string_view first_bytes);

}  // namespace soslam

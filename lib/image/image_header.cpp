// SPDX-License-Identifier: BSD-3-Clause
#include "image/image_header.h"

#include <fstream>

#include "base/file_kind.h"
#include "image/image_format.h"

namespace soslam {

std::optional<ImageHeader> ReadImageHeader(const std::filesystem::path& path) {
  if (!IsFile(path)) return std::nullopt;
  std::ifstream stream(path, std::ios::binary);
  const ImageBytes file([&](std::uint64_t begin, size_t count) {
    std::string bytes(count, '\0');
    stream.clear();  // clears an earlier end of file
    stream.seekg(static_cast<std::streamoff>(begin));
    stream.read(bytes.data(), static_cast<std::streamsize>(count));
    bytes.resize(static_cast<size_t>(std::max<std::streamsize>(0, stream.gcount())));
    return bytes;
  });
  const ImageFormat* format = FindImageFormat(file.UpTo(0, kSignatureSize));
  return format != nullptr ? format->header(file) : std::nullopt;
}

}  // namespace soslam

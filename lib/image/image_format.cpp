// SPDX-License-Identifier: BSD-3-Clause
#include "image/image_format.h"

#include <fstream>
#include <memory>

#include "base/paths.h"

namespace soslam {

std::optional<ImageHeader> ReadImageHeader(const std::filesystem::path& path) {
  if (!IsFile(path)) return std::nullopt;
  const ImageBytes file = ImageBytes::OfFile(path);
  const ImageFormat* format = FindImageFormat(file.UpTo(0, kSignatureSize));
  return format != nullptr ? format->header(file) : std::nullopt;
}

std::uint64_t NumberFromBytes(std::string_view bytes, ByteOrder order) {
  std::uint64_t number = 0;
  for (size_t i = 0; i < bytes.size(); ++i) {
    const char byte = bytes[order == ByteOrder::kBigEndian ? i : bytes.size() - 1 - i];
    number = number << 8 | static_cast<unsigned char>(byte);
  }
  return number;
}

ImageBytes::ImageBytes(std::string_view bytes)
    : read_([bytes](std::uint64_t begin, size_t count) {
        return begin < bytes.size() ? std::string(bytes.substr(begin, count)) : std::string();
      }) {}

ImageBytes ImageBytes::OfFile(const std::filesystem::path& path) {
  const auto stream = std::make_shared<std::ifstream>(path, std::ios::binary);
  return ImageBytes([stream](std::uint64_t begin, size_t count) {
    std::string bytes(count, '\0');
    stream->clear();  // clears an earlier end of file
    stream->seekg(static_cast<std::streamoff>(begin));
    stream->read(bytes.data(), static_cast<std::streamsize>(count));
    bytes.resize(static_cast<size_t>(std::max<std::streamsize>(0, stream->gcount())));
    return bytes;
  });
}

std::optional<std::string> ImageBytes::At(std::uint64_t begin, size_t count) const {
  std::string bytes = read_(begin, count);
  if (bytes.size() < count) return std::nullopt;
  return bytes;
}

std::optional<std::uint64_t> ImageBytes::NumberAt(std::uint64_t begin, size_t count,
                                                  ByteOrder order) const {
  const auto bytes = At(begin, count);
  if (!bytes) return std::nullopt;
  return NumberFromBytes(*bytes, order);
}

const ImageFormat* FindImageFormat(std::string_view first_bytes) {
  for (const ImageFormat* format :
       {&kJpegFormat, &kPngFormat, &kWebpFormat, &kBmpFormat, &kTiffFormat}) {
    if (format->has_signature(first_bytes)) return format;
  }
  return nullptr;
}

}  // namespace soslam

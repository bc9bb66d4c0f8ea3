// SPDX-License-Identifier: BSD-3-Clause
#include "image/image_bytes.h"

namespace soslam {

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

}  // namespace soslam

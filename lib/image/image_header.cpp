// SPDX-License-Identifier: BSD-3-Clause
#include "image/image_header.h"

namespace soslam {
namespace {

using namespace std::string_view_literals;

// Big endian; the bytes are there.
std::int64_t Number(std::string_view bytes, size_t begin, size_t count) {
  std::int64_t number = 0;
  for (const char byte : bytes.substr(begin, count)) {
    number = number << 8 | static_cast<unsigned char>(byte);
  }
  return number;
}

// The chunk IHDR comes first: length, name, width, height. Where it does not, decoders go by one
// that comes later.
std::optional<ImageSize> SizeOfPng(std::string_view bytes) {
  constexpr size_t kChunk = 8;
  constexpr size_t kWidth = 16;
  constexpr size_t kHeight = 20;
  if (bytes.size() < kHeight + 4 || bytes.substr(kChunk, 8) != "\0\0\0\rIHDR"sv)
    return std::nullopt;
  return ImageSize{Number(bytes, kWidth, 4), Number(bytes, kHeight, 4)};
}

// Whether a segment is one that begins a frame, SOF0 to SOF15; DHT, JPG and DAC are between them.
bool BeginsFrame(std::int64_t marker) {
  return marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
}

// Whether a marker is one that has no length after it: RST0 to RST7, TEM. None of them comes before
// a frame begins, but decoders skip them.
bool StandsAlone(std::int64_t marker) {
  return marker <= 0x01 || (marker >= 0xD0 && marker <= 0xD9);
}

// Segments have a marker, 0xFF and another byte, and a length that counts its own two bytes.
std::optional<ImageSize> SizeOfJpeg(std::string_view bytes) {
  constexpr size_t kSizeEnd = 9;  // marker 2, length 2, bits 1, height 2, width 2
  size_t begin = 2;
  while (begin + kSizeEnd <= bytes.size() && bytes[begin] == '\xff') {
    const std::int64_t marker = Number(bytes, begin + 1, 1);
    if (BeginsFrame(marker)) {
      return ImageSize{Number(bytes, begin + 7, 2), Number(bytes, begin + 5, 2)};
    }
    if (StandsAlone(marker)) return std::nullopt;
    const bool is_fill = marker == 0xFF;
    begin += is_fill ? 1 : 2 + static_cast<size_t>(Number(bytes, begin + 2, 2));
  }
  return std::nullopt;
}

}  // namespace

std::optional<ImageSize> SizeInHeader(std::string_view bytes) {
  if (bytes.starts_with("\x89PNG\r\n\x1a\n"sv)) return SizeOfPng(bytes);
  if (bytes.starts_with("\xff\xd8\xff"sv)) return SizeOfJpeg(bytes);
  return std::nullopt;
}

}  // namespace soslam

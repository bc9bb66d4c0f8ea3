// SPDX-License-Identifier: BSD-3-Clause
#include <cstdlib>

#include "image/image_format.h"

namespace soslam {
namespace {

using namespace std::string_view_literals;

constexpr ByteOrder kOrder = ByteOrder::kLittleEndian;

// Header of a bitmap, in the format of Windows (40 bytes and more) or of OS/2 (12).
struct Bitmap {
  std::uint64_t pixels_begin;
  std::int64_t width, height;
  std::int64_t bits_per_pixel;
};

bool IsBmp(std::string_view first_bytes) { return first_bytes.starts_with("BM"sv); }

// None for compressed bitmaps.
std::optional<Bitmap> ReadBitmap(const ImageBytes& file) {
  const std::string bytes = file.UpTo(0, 34);
  const auto number = [&](size_t at, size_t count) {
    return static_cast<std::int64_t>(
        NumberFromBytes(std::string_view(bytes).substr(at, count), kOrder));
  };
  if (bytes.size() < 26) return std::nullopt;
  const auto begin = static_cast<std::uint64_t>(number(10, 4));
  const std::int64_t header_size = number(14, 4);
  if (header_size == 12) return Bitmap{begin, number(18, 2), number(20, 2), number(24, 2)};
  if (header_size < 40 || bytes.size() < 34) return std::nullopt;
  const std::int64_t compression = number(30, 4);
  if (compression != 0 && compression != 3) return std::nullopt;  // plain, or plain with masks
  const auto height = static_cast<std::int32_t>(number(22, 4));   // below 0: from the top
  return Bitmap{begin, static_cast<std::int32_t>(number(18, 4)), std::abs(std::int64_t{height}),
                number(28, 2)};
}

std::optional<ImageHeader> Header(const ImageBytes& file) {
  const auto bitmap = ReadBitmap(file);
  if (!bitmap) return std::nullopt;
  return ImageHeader{{bitmap->width, bitmap->height}};
}

// Rows are padded to four bytes.
std::optional<size_t> Length(std::string_view file) {
  const auto bitmap = ReadBitmap(ImageBytes(file));
  if (!bitmap) return file.size();
  const std::int64_t row = (bitmap->width * bitmap->bits_per_pixel + 31) / 32 * 4;
  const std::uint64_t length =
      bitmap->pixels_begin + static_cast<std::uint64_t>(row * bitmap->height);
  return length <= file.size() ? std::optional(length) : std::nullopt;
}

}  // namespace

constexpr ImageFormat kBmpFormat = {"BMP", &IsBmp, &Header, &Length,
                                    "with as many pixels as it says at its beginning"};

}  // namespace soslam

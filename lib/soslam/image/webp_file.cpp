// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/image/image_format.h"
#include "soslam/image/tiff_file.h"

namespace soslam {
namespace {

using namespace std::string_view_literals;

// WebP (RFC 9649): "RIFF", length 4, "WEBP", then chunks of name 4, length 4, data and a byte that
// makes their length even.
constexpr size_t kFirstChunk = 12, kHead = 8;
constexpr ByteOrder kOrder = ByteOrder::kLittleEndian;
constexpr int kMaxChunks = 1 << 12;

bool IsWebp(std::string_view first_bytes) {
  return first_bytes.starts_with("RIFF"sv) && first_bytes.ends_with("WEBP"sv) &&
         first_bytes.size() == kSignatureSize;
}

// The flag of an animation in the chunk VP8X.
std::optional<OtherContent> Other(const ImageBytes& file) {
  constexpr std::uint64_t kIsAnimation = 2;
  const std::string chunk = file.UpTo(kFirstChunk, kHead + 1);
  const bool has_flags = chunk.starts_with("VP8X"sv) && chunk.size() == kHead + 1;
  const bool is_animation =
      has_flags && (NumberFromBytes(std::string_view(chunk).substr(kHead), kOrder) & kIsAnimation);
  return is_animation ? std::optional(OtherContent::kAnimation) : std::nullopt;
}

std::optional<ImageHeader> Header(const ImageBytes& file) {
  const auto chunk = file.At(kFirstChunk, kHead + 10);
  if (!chunk) return std::nullopt;
  const std::string_view data = std::string_view(*chunk).substr(kHead);
  const auto number = [&](size_t at, size_t count) {
    return static_cast<std::int64_t>(NumberFromBytes(data.substr(at, count), kOrder));
  };
  // The canvas of a file of several chunks (VP8X), or the size of its only picture, compressed with
  // loss (VP8) or without (VP8L).
  constexpr std::int64_t kFourteenBits = 0x3fff;
  ImageSize size;
  if (chunk->starts_with("VP8X"sv)) {
    size = {number(4, 3) + 1, number(7, 3) + 1};
  } else if (chunk->starts_with("VP8 "sv) && data.substr(3, 3) == "\x9d\x01\x2a"sv) {
    size = {number(6, 2) & kFourteenBits, number(8, 2) & kFourteenBits};
  } else if (chunk->starts_with("VP8L"sv) && data[0] == '\x2f') {
    size = {(number(1, 4) & kFourteenBits) + 1, (number(1, 4) >> 14 & kFourteenBits) + 1};
  } else {
    return std::nullopt;
  }
  constexpr size_t kMaxExif = 1 << 16;
  std::string exif;
  std::uint64_t begin = kFirstChunk;
  for (int i = 0; i < kMaxChunks; ++i) {
    const auto head = file.At(begin, kHead);
    if (!head) break;
    const std::uint64_t length = NumberFromBytes(std::string_view(*head).substr(4), kOrder);
    if (head->starts_with("EXIF"sv)) {
      exif = file.UpTo(begin + kHead, std::min<size_t>(length, kMaxExif));
      if (exif.starts_with("Exif\0\0"sv)) exif.erase(0, 6);  // JPEG's, which some writers keep
      break;
    }
    begin += kHead + length + length % 2;
  }
  return ImageHeader{size, ExifOrientation(exif).value_or(1), std::nullopt, ExifTimeTaken(exif)};
}

}  // namespace

constexpr ImageFormat kWebpFormat = {"WebP", &IsWebp, &Header, nullptr, nullptr, nullptr, &Other};

}  // namespace soslam

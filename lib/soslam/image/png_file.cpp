// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/image/image_format.h"
#include "soslam/image/tiff_file.h"

namespace soslam {
namespace {

using namespace std::string_view_literals;

// PNG (ISO/IEC 15948): a signature, then chunks of length 4, name 4, data, checksum 4.
constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n"sv;
constexpr size_t kHead = 8, kChecksum = 4;
constexpr std::uint64_t kMaxChunk = 0x7fffffff;
constexpr ByteOrder kOrder = ByteOrder::kBigEndian;
constexpr int kMaxChunks = 1 << 16;

bool IsPng(std::string_view first_bytes) { return first_bytes.starts_with(kSignature); }

// The first data of a chunk with this name, at most `most` bytes; empty if there is none.
std::string ReadChunk(const ImageBytes& file, std::string_view name, size_t most) {
  std::uint64_t begin = kSignature.size();
  for (int i = 0; i < kMaxChunks; ++i) {
    const auto head = file.At(begin, kHead);
    if (!head || head->ends_with("IEND"sv)) break;
    const std::uint64_t length = NumberFromBytes(std::string_view(*head).substr(0, 4), kOrder);
    if (head->ends_with(name)) return file.UpTo(begin + kHead, std::min<size_t>(length, most));
    begin += kHead + length + kChecksum;
  }
  return "";
}

// An animation (APNG) has the chunk acTL, which begins with the number of its images.
std::optional<OtherContent> Other(const ImageBytes& file) {
  const std::uint64_t images = NumberFromBytes(ReadChunk(file, "acTL"sv, 4), kOrder);
  return images > 1 ? std::optional(OtherContent::kAnimation) : std::nullopt;
}

// Width and height from the chunk IHDR, which comes first. None if it does not, as decoders then
// use one that comes later.
std::optional<ImageHeader> Header(const ImageBytes& file) {
  const auto ihdr = file.At(kSignature.size(), kHead + 8);
  if (!ihdr || !ihdr->starts_with("\0\0\0\rIHDR"sv)) return std::nullopt;
  const auto side = [&](size_t at) {
    return static_cast<std::int64_t>(
        NumberFromBytes(std::string_view(*ihdr).substr(kHead + at, 4), kOrder));
  };
  constexpr size_t kMaxExif = 1 << 16;
  const std::string exif = ReadChunk(file, "eXIf"sv, kMaxExif);  // before or after the pixels
  return ImageHeader{
      {side(0), side(4)}, ExifOrientation(exif).value_or(1), std::nullopt, ExifTimeTaken(exif)};
}

std::optional<size_t> Length(std::string_view file) {
  size_t begin = kSignature.size();
  while (begin + kHead + kChecksum <= file.size()) {
    const std::uint64_t length = NumberFromBytes(file.substr(begin, 4), kOrder);
    const bool is_end = file.substr(begin + 4, 4) == "IEND"sv;
    if (length > kMaxChunk) return std::nullopt;
    begin += kHead + length + kChecksum;
    if (is_end) return begin <= file.size() ? std::optional(begin) : std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

constexpr ImageFormat kPngFormat = {
    "PNG", &IsPng, &Header, &Length, "that ends with the chunk IEND", nullptr, &Other};

}  // namespace soslam

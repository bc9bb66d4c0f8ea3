// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/image/image_format.h"
#include "soslam/image/tiff_file.h"

namespace soslam {
namespace {

using namespace std::string_view_literals;

// JPEG, ITU-T T.81, annex B: segments have a marker (0xFF and another byte) and a length that
// includes its own two bytes. Coded data follow the header of a scan; 0xFF is followed by 0 in
// them.
constexpr std::uint64_t kStartOfImage = 0xD8, kEndOfImage = 0xD9, kStartOfScan = 0xDA, kApp1 = 0xE1;
constexpr std::uint64_t kFill = 0xFF;
constexpr ByteOrder kOrder = ByteOrder::kBigEndian;
constexpr int kMaxSegments = 1 << 16;

// True for markers that no length follows: stuffing, TEM, RST0 to RST7, SOI, EOI.
bool StandsAlone(std::uint64_t marker) {
  return marker <= 0x01 || (marker >= 0xD0 && marker <= 0xD9);
}

bool IsJpeg(std::string_view first_bytes) { return first_bytes.starts_with("\xff\xd8\xff"sv); }

// Reads the segments before the first scan. No marker without a length belongs there, but decoders
// skip such markers.
std::optional<ImageHeader> Header(const ImageBytes& file) {
  std::optional<ImageSize> size;
  std::optional<int> orientation;
  std::string exif;  // that with the orientation, otherwise the last
  std::uint64_t begin = 2;
  for (int i = 0; i < kMaxSegments; ++i) {
    const std::string head = file.UpTo(begin, 9);  // marker 2, length 2, bits 1, height 2, width 2
    if (head.size() < 4 || head[0] != '\xff') break;
    const auto number = [&](size_t at, size_t count) {
      return NumberFromBytes(std::string_view(head).substr(at, count), kOrder);
    };
    const std::uint64_t marker = number(1, 1);
    if (marker == kFill) {
      ++begin;
      continue;
    }
    const std::uint64_t length = number(2, 2);
    if (marker == kStartOfScan || StandsAlone(marker) || length < 2) break;
    // Frames begin with SOF0 to SOF15; DHT, JPG and DAC lie between them.
    const bool begins_frame =
        marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
    if (begins_frame && !size && head.size() == 9) {
      size = {static_cast<std::int64_t>(number(7, 2)), static_cast<std::int64_t>(number(5, 2))};
    }
    if (marker == kApp1 && !orientation) {
      constexpr std::string_view kName = "Exif\0\0"sv;
      const std::string data = file.UpTo(begin + 4, length - 2);
      if (data.starts_with(kName)) exif = data.substr(kName.size());
      orientation = ExifOrientation(exif);
    }
    begin += 2 + length;
  }
  if (!size) return std::nullopt;
  return ImageHeader{*size, orientation.value_or(1), ExifFocalOverDiagonal(exif, *size),
                     ExifTimeTaken(exif)};
}

// Length up to the marker EOI that is not within a segment, as those of thumbnails are.
std::optional<size_t> Length(std::string_view file) {
  bool is_after_scan = false;
  size_t begin = 2;
  while ((begin = file.find('\xff', begin)) != file.npos && begin + 1 < file.size()) {
    const std::uint64_t marker = NumberFromBytes(file.substr(begin + 1, 1), kOrder);
    if (marker == kEndOfImage) return begin + 2;
    if (marker == kStartOfImage) return std::nullopt;  // another image begins
    if (marker == kFill) {
      ++begin;
    } else if (StandsAlone(marker)) {
      begin += 2;
    } else {
      // Tables, the next scan and application data may follow coded data.
      const bool may_follow_scan = marker == 0xC4 || marker == 0xCC ||
                                   (marker >= 0xDA && marker <= 0xDD) ||
                                   (marker >= 0xE0 && marker <= 0xEF) || marker == 0xFE;
      const bool is_there = begin + 4 <= file.size();
      if (!is_there || (is_after_scan && !may_follow_scan)) return std::nullopt;
      begin += 2 + NumberFromBytes(file.substr(begin + 2, 2), kOrder);
      is_after_scan = is_after_scan || marker == kStartOfScan;
    }
  }
  return std::nullopt;
}

}  // namespace

constexpr ImageFormat kJpegFormat = {"JPEG", &IsJpeg, &Header, &Length,
                                     "that ends with the marker EOI"};

}  // namespace soslam

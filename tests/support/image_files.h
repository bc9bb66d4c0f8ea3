// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "soslam/image/image_format.h"

namespace soslam {

inline std::string EncodedImage(const std::string& extension, const cv::Mat& image,
                                const std::vector<int>& parameters = {}) {
  std::vector<uchar> bytes;
  cv::imencode(extension, image, bytes, parameters);
  return {bytes.begin(), bytes.end()};
}

inline std::string NumberBytes(std::uint64_t number, size_t count, ByteOrder order) {
  std::string bytes;
  for (size_t i = 0; i < count; ++i) bytes += static_cast<char>(number >> 8 * i);
  if (order == ByteOrder::kBigEndian) std::ranges::reverse(bytes);
  return bytes;
}

// A TIFF file, as EXIF is one: its directory first, of SHORTs and LONGs by tag, then `rest`, which
// begins at TiffRest(number of entries).
struct TiffField {
  std::uint64_t tag;
  std::uint64_t number;
  std::uint64_t type = 3;  // SHORT; 4: LONG, 2: ASCII, 10: SRATIONAL
  std::uint64_t count = 1;
};
inline size_t TiffRest(size_t entries) { return 8 + 2 + 12 * entries + 4; }
inline std::string Tiff(ByteOrder order, const std::vector<TiffField>& fields,
                        const std::string& rest = "") {
  const auto number = [&](std::uint64_t value, size_t count) {
    return NumberBytes(value, count, order);
  };
  std::string bytes = order == ByteOrder::kBigEndian ? "MM" : "II";
  bytes += number(42, 2) + number(8, 4) + number(fields.size(), 2);
  for (const TiffField& field : fields) {
    bytes += number(field.tag, 2) + number(field.type, 2) + number(field.count, 4);
    bytes +=
        field.type == 3 ? number(field.number, 2) + std::string(2, '\0') : number(field.number, 4);
  }
  return bytes + number(0, 4) + rest;
}

inline std::string ExifOf(int orientation, ByteOrder order = ByteOrder::kBigEndian,
                          const std::string& rest = "") {
  return Tiff(order, {{274, static_cast<std::uint64_t>(orientation)}}, rest);
}

inline std::string JpegSegment(char marker, const std::string& data) {
  return std::string("\xff") + marker + NumberBytes(data.size() + 2, 2, ByteOrder::kBigEndian) +
         data;
}

inline std::string JpegWithExif(std::string jpeg, const std::string& exif) {
  return jpeg.insert(2, JpegSegment('\xe1', std::string("Exif\0\0", 6) + exif));
}

// The checksum of PNG: CRC-32, bit by bit.
inline std::uint32_t Crc32(const std::string& bytes) {
  std::uint32_t crc = ~0U;
  for (const char byte : bytes) {
    crc ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1) != 0 ? 0xedb88320U : 0U);
  }
  return ~crc;
}

inline std::string PngChunk(const std::string& name, const std::string& data) {
  return NumberBytes(data.size(), 4, ByteOrder::kBigEndian) + name + data +
         NumberBytes(Crc32(name + data), 4, ByteOrder::kBigEndian);
}

inline std::string PngWithExif(std::string png, const std::string& exif, bool is_after_pixels) {
  constexpr size_t kAfterIhdr = 33, kIend = 12;
  const size_t place = is_after_pixels ? png.size() - kIend : kAfterIhdr;
  return png.insert(place, PngChunk("eXIf", exif));
}

// A WebP file of one chunk as one of several, with EXIF after the pixels.
inline std::string WebpWithExif(const std::string& webp, const cv::Size& size,
                                const std::string& exif) {
  const auto chunk = [](const std::string& name, const std::string& data) {
    return name + NumberBytes(data.size(), 4, ByteOrder::kLittleEndian) + data +
           std::string(data.size() % 2, '\0');
  };
  const auto side = [](int pixels) {
    return NumberBytes(static_cast<std::uint64_t>(pixels - 1), 3, ByteOrder::kLittleEndian);
  };
  constexpr char kHasExif = 8;
  const std::string body =
      "WEBP" +
      chunk("VP8X", std::string{kHasExif, 0, 0, 0} + side(size.width) + side(size.height)) +
      webp.substr(12) + chunk("EXIF", exif);
  return chunk("RIFF", body);
}

// Grey values as a TIFF file of one strip, which is not packed.
inline std::string GreyTiff(const cv::Mat& image, int orientation, ByteOrder order) {
  constexpr size_t kEntries = 9;
  const auto width = static_cast<std::uint64_t>(image.cols);
  const auto height = static_cast<std::uint64_t>(image.rows);
  const std::string pixels(image.datastart, image.dataend);
  return Tiff(order,
              {{256, width},
               {257, height},
               {258, 8},
               {259, 1},
               {262, 1},  // 0 is black
               {273, TiffRest(kEntries), 4},
               {274, static_cast<std::uint64_t>(orientation)},
               {278, height},
               {279, pixels.size(), 4}},
              pixels);
}

// An image of a TIFF file, little-endian, `begin` bytes after its beginning: a directory with
// further fields, and grey values that are not packed. `next` is the place of the next image.
inline std::string TiffImage(const cv::Mat& grey, size_t begin, std::vector<TiffField> fields = {},
                             size_t next = 0) {
  constexpr ByteOrder kOrder = ByteOrder::kLittleEndian;
  constexpr std::uint64_t kPhotometric = 262;
  const std::string pixels(grey.datastart, grey.dataend);
  if (std::ranges::find(fields, kPhotometric, &TiffField::tag) == fields.end()) {
    fields.push_back({kPhotometric, 1});  // 0 is black
  }
  const auto height = static_cast<std::uint64_t>(grey.rows);
  const size_t pixels_begin = begin + TiffRest(fields.size() + 7) - 8;
  fields.insert(fields.end(), {{256, static_cast<std::uint64_t>(grey.cols)},
                               {257, height},
                               {258, 8},
                               {259, 1},
                               {273, pixels_begin, 4},
                               {278, height},
                               {279, pixels.size(), 4}});
  std::ranges::sort(fields, {}, &TiffField::tag);
  const std::string directory = Tiff(kOrder, fields).substr(8);
  return directory.substr(0, directory.size() - 4) + NumberBytes(next, 4, kOrder) + pixels;
}

// A TIFF file of two images, the second one with further fields.
inline std::string TiffOfTwo(const cv::Mat& first, const cv::Mat& second,
                             const std::vector<TiffField>& fields_of_second) {
  const std::string header = Tiff(ByteOrder::kLittleEndian, {}).substr(0, 8);
  const size_t next = 8 + TiffImage(first, 8).size();
  return header + TiffImage(first, 8, {}, next) + TiffImage(second, next, fields_of_second);
}

// A TIFF file whose second image is in a directory below the first one (SubIFDs). By default, the
// first is its thumbnail, as in RAW photos.
inline std::string TiffWithImageBelow(const cv::Mat& first, const cv::Mat& below,
                                      std::uint64_t subfile_of_first = 1,
                                      std::uint64_t subfile_of_below = 0) {
  const auto fields = [&](size_t place) {
    return std::vector<TiffField>{{254, subfile_of_first, 4}, {330, place, 4}};
  };
  const size_t place = 8 + TiffImage(first, 8, fields(0)).size();
  return Tiff(ByteOrder::kLittleEndian, {}).substr(0, 8) + TiffImage(first, 8, fields(place)) +
         TiffImage(below, place, {{254, subfile_of_below, 4}});
}

}  // namespace soslam

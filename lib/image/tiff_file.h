// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "image/image_format.h"

namespace soslam {

inline constexpr std::uint64_t kTiffOrientation = 274;

// A tag of a TIFF file and its numbers.
struct TiffEntry {
  std::uint64_t tag;
  size_t bytes_each;    // bytes per number; 0 if they are not unsigned integers
  bool is_ratio;        // each value is a RATIONAL: two unsigned integers of 4 bytes
  std::uint64_t count;  // as the file claims
  std::uint64_t begin;  // offset in the file
};

// The first directory of a TIFF file (TIFF 6.0, section 2). EXIF data are a TIFF file within
// another.
class TiffDirectory {
 public:
  // None if the file is no TIFF file, or ends before the directory does.
  static std::optional<TiffDirectory> Read(const ImageBytes& file);
  // The directory that an entry with this tag points to, as EXIF's own; none as for Read.
  std::optional<TiffDirectory> SubDirectory(std::uint64_t tag) const;

  ByteOrder order() const { return order_; }
  // The first entry with this tag; none if there is none, or its numbers are not unsigned integers.
  std::optional<TiffEntry> Find(std::uint64_t tag) const;
  // Number of entries with this tag.
  std::ptrdiff_t Count(std::uint64_t tag) const;
  // The first number of the first entry with this tag; none if there is none, or it is not in the
  // file.
  std::optional<std::uint64_t> Number(std::uint64_t tag) const;
  // The first ratio of the first entry with this tag; none also if its denominator is zero.
  std::optional<double> Ratio(std::uint64_t tag) const;

 private:
  static std::optional<TiffDirectory> ReadAt(std::uint64_t begin, ByteOrder order,
                                             const ImageBytes& file);
  TiffDirectory(ImageBytes file, ByteOrder order, std::vector<TiffEntry> entries)
      : file_(std::move(file)), order_(order), entries_(std::move(entries)) {}

  ImageBytes file_;
  ByteOrder order_;
  std::vector<TiffEntry> entries_;
};

// The orientation in EXIF data, 1 to 8; none if they have none.
std::optional<int> ExifOrientation(std::string_view exif);
std::optional<int> ExifOrientation(const TiffDirectory& exif);

// The focal length in EXIF data over the diagonal of the image, which has `stored` pixels: a guess,
// as cameras round it. From FocalLengthIn35mmFilm, otherwise from FocalLength and the resolution of
// the sensor. None if the data have neither, an absurd one, or one of an image that was cropped
// since.
std::optional<double> ExifFocalOverDiagonal(std::string_view exif, const ImageSize& stored);

// A segment of a JPEG file with EXIF data that have this focal length only, rounded to a millimetre
// of 35 mm film.
std::string FocalLengthSegment(double focal_over_diagonal);

}  // namespace soslam

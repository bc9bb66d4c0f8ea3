// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "image/image_bytes.h"

namespace soslam {

inline constexpr std::uint64_t kTiffOrientation = 274;

// Numbers that a TIFF file has under a tag.
struct TiffEntry {
  std::uint64_t tag;
  size_t bytes_each;    // 0: not whole numbers without sign
  std::uint64_t count;  // as the file claims
  std::uint64_t begin;  // in the file
};

// The first directory of a TIFF file (TIFF 6.0, section 2). EXIF is such a file within others.
class TiffDirectory {
 public:
  // None where it is no TIFF file, or cut short before the directory's end.
  static std::optional<TiffDirectory> Read(const ImageBytes& file);

  ByteOrder order() const { return order_; }
  // The first entry with this tag; none where there is none, or it has no whole numbers.
  std::optional<TiffEntry> Find(std::uint64_t tag) const;
  // How many entries have this tag.
  std::ptrdiff_t Count(std::uint64_t tag) const;
  // The first number of the first entry; none where there is none, or it is not in the file.
  std::optional<std::uint64_t> Number(std::uint64_t tag, const ImageBytes& file) const;

 private:
  TiffDirectory(ByteOrder order, std::vector<TiffEntry> entries)
      : order_(order), entries_(std::move(entries)) {}

  ByteOrder order_;
  std::vector<TiffEntry> entries_;
};

// The orientation that EXIF data say, 1 to 8; none where they say none.
std::optional<int> ExifOrientation(std::string_view exif);
std::optional<int> ExifOrientation(const TiffDirectory& exif, const ImageBytes& file);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <compare>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "soslam/geometry/image_size.h"

namespace soslam {

struct ImageSize {
  std::int64_t width = 0;
  std::int64_t height = 0;

  auto operator<=>(const ImageSize&) const = default;  // NOLINT(modernize-use-nullptr): clang 14
};

// Properties that an image file states before any pixel is decoded.
struct ImageHeader {
  ImageSize stored;     // size of the pixels that the file stores
  int orientation = 1;  // EXIF's, 1 to 8: 1 upright, 3 upside down, 5 to 8 turned by a quarter
  // Focal length over the diagonal of the image, from the EXIF data of a JPEG file.
  std::optional<double> focal_over_diagonal = std::nullopt;
  // When the photo was taken, by ExifTimeTaken; empty if unknown.
  std::string time_taken = {};

  bool IsTurnedByAQuarter() const { return orientation >= 5; }
  // The size of the image when it is read with this setting.
  ImageSize Size(ImageOrientation read_as) const {
    const bool swaps = read_as == ImageOrientation::kUpright && IsTurnedByAQuarter();
    return swaps ? ImageSize{stored.height, stored.width} : stored;
  }
};

// Reads only the necessary part of the file, usually a few hundred bytes. None for a file that
// cannot be opened, is of no format that FindImageFormat knows, has other content than one image,
// or ends before its size.
std::optional<ImageHeader> ReadImageHeader(const std::filesystem::path& path);

enum class ByteOrder { kLittleEndian, kBigEndian };

// An unsigned integer stored in at most eight bytes.
std::uint64_t NumberFromBytes(std::string_view bytes, ByteOrder order);

// Access to the bytes of a file, in memory or on disk: reads only the bytes that are requested.
class ImageBytes {
 public:
  // `read` returns `count` bytes from `begin` on, fewer at the end of the file.
  using ReadAt = std::function<std::string(std::uint64_t begin, size_t count)>;
  explicit ImageBytes(ReadAt read) : read_(std::move(read)) {}
  // Reads from `bytes`, which must outlive this object.
  explicit ImageBytes(std::string_view bytes);
  // Reads from a file on disk; one that cannot be opened has no bytes.
  static ImageBytes OfFile(const std::filesystem::path& path);

  // Up to `count` bytes from `begin` on, fewer at the end of the file.
  std::string UpTo(std::uint64_t begin, size_t count) const { return read_(begin, count); }
  // Exactly `count` bytes; none when there are fewer.
  std::optional<std::string> At(std::uint64_t begin, size_t count) const;
  // These bytes as an unsigned integer.
  std::optional<std::uint64_t> NumberAt(std::uint64_t begin, size_t count, ByteOrder order) const;

 private:
  ReadAt read_;
};

// Content of files that resemble an image. What decoders show of a RAW photo is its thumbnail, and
// of several images the first.
enum class OtherContent { kRawPhoto, kSeveralImages, kAnimation };

// Empty for one image, and for unknown content. RAW photos are recognised by their content,
// also under another name, and by the extensions of cameras.
std::optional<OtherContent> FindOtherContent(const std::filesystem::path& path,
                                             const ImageBytes& file);

// True for a name with an extension of RAW photos.
bool HasNameOfRawPhoto(const std::filesystem::path& path);
bool IsRawPhoto(const std::filesystem::path& path);

// A format of image files. OpenCV decodes more formats; some of them allocate as much memory as a
// few bytes demand, or read other files.
struct ImageFormat {
  const char* name;
  bool (*has_signature)(
      std::string_view first_bytes);  // kSignatureSize bytes, or all if the file has fewer
  // The header of a file. None if it has no size, or one that a decoder might read differently.
  std::optional<ImageHeader> (*header)(const ImageBytes& file);
  // Number of bytes that the image takes: phones and others append data of their own. None if the
  // file is truncated. Null for formats whose decoders refuse truncated files; those of others fill
  // in the missing part without an error.
  std::optional<size_t> (*length)(std::string_view file) = nullptr;
  // How to distinguish a complete file from a truncated one, for error messages.
  const char* whole = nullptr;
  // Sets the file's orientation to 1, for formats whose decoders turn images unasked; else null.
  void (*clear_orientation)(std::span<char> file) = nullptr;
  // Other content of a file of this format than one image; null if the format allows none.
  std::optional<OtherContent> (*other_content)(const ImageBytes& file) = nullptr;
};
inline constexpr size_t kSignatureSize = 12;

extern const ImageFormat kJpegFormat, kPngFormat, kWebpFormat, kBmpFormat, kTiffFormat;

// The format of a file by its first bytes; null if it is none of these.
const ImageFormat* FindImageFormat(std::string_view first_bytes);

}  // namespace soslam

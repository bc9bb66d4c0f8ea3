// SPDX-License-Identifier: BSD-3-Clause
#include "image/exif_focal_length.h"

#include <algorithm>
#include <cmath>

#include "image/tiff_file.h"

namespace soslam {
namespace {

// EXIF 2.32, section 4.6.
constexpr std::uint64_t kExifDirectory = 0x8769;
constexpr std::uint64_t kFocalLength = 0x920A, kFocalLengthIn35mmFilm = 0xA405;
constexpr std::uint64_t kPixelXDimension = 0xA002, kPixelYDimension = 0xA003;
constexpr std::uint64_t kFocalPlaneXResolution = 0xA20E, kFocalPlaneResolutionUnit = 0xA210;

constexpr double kFilmDiagonalMm = 43.267;

// Size of the image that the camera wrote.
std::optional<ImageSize> SizeInExif(const TiffDirectory& exif, const ImageBytes& file) {
  const auto width = exif.Number(kPixelXDimension, file).value_or(0);
  const auto height = exif.Number(kPixelYDimension, file).value_or(0);
  if (width == 0 || height == 0) return std::nullopt;
  return ImageSize{static_cast<std::int64_t>(width), static_cast<std::int64_t>(height)};
}

double Diagonal(const ImageSize& size) {
  return std::hypot(static_cast<double>(size.width), static_cast<double>(size.height));
}

// Longer side over shorter side, which scaling and turning leave as they are.
double AspectOf(const ImageSize& size) {
  const auto [shorter, longer] = std::minmax(size.width, size.height);
  return static_cast<double>(longer) / static_cast<double>(shorter);
}

std::optional<double> FromSensor(const TiffDirectory& exif, const ImageSize& written,
                                 const ImageBytes& file) {
  constexpr std::uint64_t kInch = 2, kCentimetre = 3;
  const auto focal_mm = exif.Ratio(kFocalLength, file);
  const auto pixels_per_unit = exif.Ratio(kFocalPlaneXResolution, file);
  const auto unit = exif.Number(kFocalPlaneResolutionUnit, file).value_or(kInch);
  if (!focal_mm || !pixels_per_unit || (unit != kInch && unit != kCentimetre)) return std::nullopt;
  return *focal_mm * *pixels_per_unit / (unit == kInch ? 25.4 : 10.0) / Diagonal(written);
}

}  // namespace

std::string FocalLengthSegment(double focal_over_diagonal) {
  const auto focal_mm =
      static_cast<std::uint64_t>(std::max(1.0, std::round(focal_over_diagonal * kFilmDiagonalMm)));
  const auto number = [](std::uint64_t value, size_t count) {
    std::string bytes;
    for (size_t i = 0; i < count; ++i) bytes += static_cast<char>(value >> 8 * i & 0xFF);
    return bytes;
  };
  // A directory of one entry and no next one: count, tag, type, count of values, value.
  const auto directory = [&](std::uint64_t tag, std::uint64_t type, std::uint64_t value) {
    return number(1, 2) + number(tag, 2) + number(type, 2) + number(1, 4) + number(value, 4) +
           number(0, 4);
  };
  constexpr std::uint64_t kShort = 3, kLong = 4, kFirst = 8, kSecond = 26;
  const std::string exif = std::string("Exif\0\0II*\0", 10) + number(kFirst, 4) +
                           directory(kExifDirectory, kLong, kSecond) +
                           directory(kFocalLengthIn35mmFilm, kShort, focal_mm);
  const auto size = static_cast<char>(exif.size() + 2);  // below 256
  return std::string("\xff\xe1\0", 3) + size + exif;
}

std::optional<double> ExifFocalOverDiagonal(std::string_view exif, const ImageSize& stored) {
  constexpr double kMin = 0.2, kMax = 10.0, kMaxAspectChange = 0.02;
  const ImageBytes file(exif);
  const auto first = TiffDirectory::Read(file);
  const auto directory = first ? first->SubDirectory(kExifDirectory, file) : std::nullopt;
  if (!directory || stored.width <= 0 || stored.height <= 0) return std::nullopt;
  const auto written = SizeInExif(*directory, file);
  const bool is_cropped =
      written && std::abs(AspectOf(*written) / AspectOf(stored) - 1.0) > kMaxAspectChange;
  if (is_cropped) return std::nullopt;
  const auto film_mm = directory->Number(kFocalLengthIn35mmFilm, file).value_or(0);
  const auto focal = film_mm > 0 ? std::optional(static_cast<double>(film_mm) / kFilmDiagonalMm)
                                 : FromSensor(*directory, written.value_or(stored), file);
  return focal && *focal >= kMin && *focal <= kMax ? focal : std::nullopt;
}

}  // namespace soslam

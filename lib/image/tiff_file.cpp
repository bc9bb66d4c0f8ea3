// SPDX-License-Identifier: BSD-3-Clause
#include "image/tiff_file.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <vector>

namespace soslam {
namespace {

using namespace std::string_view_literals;

constexpr std::uint64_t kTiffOrientation = 274;

std::optional<ByteOrder> OrderOf(std::string_view head) {
  if (head == "II*\0"sv) return ByteOrder::kLittleEndian;
  if (head == "MM\0*"sv) return ByteOrder::kBigEndian;
  return std::nullopt;
}

// A tag of a TIFF file and its numbers.
struct TiffEntry {
  std::uint64_t tag;
  size_t bytes_each;    // bytes per number; 0 if they are not unsigned integers
  bool is_ratio;        // each value is a RATIONAL: two unsigned integers of 4 bytes
  std::uint64_t count;  // as the file claims
  std::uint64_t begin;  // offset in the file
};

// Bytes per number of type BYTE, SHORT or LONG; 0 for other types.
size_t BytesEach(std::uint64_t type) {
  constexpr size_t kBytes[] = {0, 1, 0, 2, 4};
  return type < std::size(kBytes) ? kBytes[type] : 0;
}

TiffEntry ParseEntry(std::string_view bytes, std::uint64_t begin, ByteOrder order) {
  const auto number = [&](size_t at, size_t count) {
    return NumberFromBytes(bytes.substr(at, count), order);
  };
  constexpr std::uint64_t kRational = 5;
  const std::uint64_t type = number(2, 2);
  TiffEntry entry{number(0, 2), BytesEach(type), type == kRational, number(4, 4), begin + 8};
  if (entry.is_ratio || entry.bytes_each * entry.count > 4) entry.begin = number(8, 4);
  return entry;
}

// The first directory of a TIFF file (TIFF 6.0, section 2). EXIF data are a TIFF file within
// another.
class TiffDirectory {
 public:
  // None if the file is no TIFF file, or ends before the directory does.
  static std::optional<TiffDirectory> Read(const ImageBytes& file) {
    const auto order = OrderOf(file.UpTo(0, 4));
    if (!order) return std::nullopt;
    const auto begin = file.NumberAt(4, 4, *order);
    return begin ? ReadAt(*begin, *order, file) : std::nullopt;
  }

  // The directory that an entry with this tag points to, as EXIF's own; none as for Read.
  std::optional<TiffDirectory> SubDirectory(std::uint64_t tag) const {
    const auto begin = Number(tag);
    return begin ? ReadAt(*begin, order_, file_) : std::nullopt;
  }

  ByteOrder order() const { return order_; }

  // The first entry with this tag; none if there is none, or its numbers are not unsigned integers.
  std::optional<TiffEntry> Find(std::uint64_t tag) const {
    const auto found = std::ranges::find(entries_, tag, &TiffEntry::tag);
    if (found == entries_.end() || found->bytes_each == 0 || found->count == 0) return std::nullopt;
    return *found;
  }

  // Number of entries with this tag.
  std::ptrdiff_t Count(std::uint64_t tag) const {
    return std::ranges::count(entries_, tag, &TiffEntry::tag);
  }

  // The first number of the first entry with this tag; none if there is none, or it is not in the
  // file.
  std::optional<std::uint64_t> Number(std::uint64_t tag) const {
    const auto entry = Find(tag);
    return entry ? file_.NumberAt(entry->begin, entry->bytes_each, order_) : std::nullopt;
  }

  // The first ratio of the first entry with this tag; none also if its denominator is zero.
  std::optional<double> Ratio(std::uint64_t tag) const {
    const auto found = std::ranges::find(entries_, tag, &TiffEntry::tag);
    if (found == entries_.end() || !found->is_ratio || found->count == 0) return std::nullopt;
    const auto numerator = file_.NumberAt(found->begin, 4, order_);
    const auto denominator = file_.NumberAt(found->begin + 4, 4, order_);
    if (!numerator || !denominator || *denominator == 0) return std::nullopt;
    return static_cast<double>(*numerator) / static_cast<double>(*denominator);
  }

 private:
  TiffDirectory(ImageBytes file, ByteOrder order) : file_(std::move(file)), order_(order) {}

  static std::optional<TiffDirectory> ReadAt(std::uint64_t begin, ByteOrder order,
                                             const ImageBytes& file) {
    constexpr size_t kEntrySize = 12;  // tag 2, type 2, count 4, value or its offset 4
    const auto count = file.NumberAt(begin, 2, order);
    const auto bytes = count ? file.At(begin + 2, *count * kEntrySize) : std::nullopt;
    if (!bytes) return std::nullopt;
    TiffDirectory directory(file, order);
    for (size_t at = 0; at < bytes->size(); at += kEntrySize) {
      directory.entries_.push_back(
          ParseEntry(std::string_view(*bytes).substr(at, kEntrySize), begin + 2 + at, order));
    }
    return directory;
  }

  ImageBytes file_;
  ByteOrder order_;
  std::vector<TiffEntry> entries_;
};

std::optional<int> OrientationIn(const TiffDirectory& directory) {
  const auto orientation = directory.Number(kTiffOrientation);
  if (!orientation || *orientation < 1 || *orientation > 8) return std::nullopt;
  return static_cast<int>(*orientation);
}

}  // namespace

std::optional<int> ExifOrientation(std::string_view exif) {
  const auto directory = TiffDirectory::Read(ImageBytes(exif));
  return directory ? OrientationIn(*directory) : std::nullopt;
}

namespace {

// TIFF 6.0, section 8 and "Tiled images".
constexpr std::uint64_t kWidth = 256, kHeight = 257, kBitsPerSample = 258, kCompression = 259;
constexpr std::uint64_t kSamplesPerPixel = 277;
constexpr std::uint64_t kStripOffsets = 273, kStripByteCounts = 279;
constexpr std::uint64_t kTileWidth = 322, kTileHeight = 323, kTileOffsets = 324;
constexpr std::uint64_t kTileByteCounts = 325;

bool IsTiff(std::string_view first_bytes) { return OrderOf(first_bytes.substr(0, 4)).has_value(); }

bool IsOneOf(std::uint64_t number, std::initializer_list<std::uint64_t> numbers) {
  return std::ranges::find(numbers, number) != numbers.end();
}

// True if the pixels are stored in a supported way: 1, 8 or 16 bits per sample, up to four samples;
// uncompressed, or packed by LZW, JPEG, deflate or run lengths; in strips, or in tiles of a
// plausible size.
bool IsReadable(const TiffDirectory& directory) {
  constexpr std::uint64_t kMaxTileSide = 1 << 13;
  const auto number = [&](std::uint64_t tag, std::uint64_t otherwise) {
    return directory.Count(tag) > 0 ? directory.Number(tag).value_or(0) : otherwise;
  };
  return IsOneOf(number(kBitsPerSample, 1), {1, 8, 16}) &&
         IsOneOf(number(kSamplesPerPixel, 1), {1, 2, 3, 4}) &&
         IsOneOf(number(kCompression, 1), {1, 5, 7, 8, 32773, 32946}) &&
         number(kTileWidth, 0) <= kMaxTileSide && number(kTileHeight, 0) <= kMaxTileSide;
}

// True if decoders cannot use any other value than the first: no tag is there twice.
bool IsUnambiguous(const TiffDirectory& directory) {
  return std::ranges::all_of(
      std::initializer_list<std::uint64_t>{kWidth, kHeight, kBitsPerSample, kCompression,
                                           kSamplesPerPixel, kStripOffsets, kStripByteCounts,
                                           kTileWidth, kTileHeight, kTileOffsets, kTileByteCounts,
                                           kTiffOrientation},
      [&](std::uint64_t tag) { return directory.Count(tag) <= 1; });
}

// Header of the first page.
std::optional<ImageHeader> Header(const ImageBytes& file) {
  const auto directory = TiffDirectory::Read(file);
  if (!directory || !IsUnambiguous(*directory) || !IsReadable(*directory)) {
    return std::nullopt;
  }
  const auto width = directory->Number(kWidth);
  const auto height = directory->Number(kHeight);
  if (!width || !height) return std::nullopt;
  return ImageHeader{{static_cast<std::int64_t>(*width), static_cast<std::int64_t>(*height)},
                     OrientationIn(*directory).value_or(1)};
}

// True if all numbers of both entries are in the file, and so are the blocks (offset and length)
// that they state.
bool AreInFile(const TiffEntry& places, const TiffEntry& lengths, ByteOrder order,
               std::string_view file) {
  const auto number = [&](const TiffEntry& entry, std::uint64_t i) {
    return ImageBytes(file).NumberAt(entry.begin + i * entry.bytes_each, entry.bytes_each, order);
  };
  if (places.count != lengths.count) return false;
  for (std::uint64_t i = 0; i < places.count; ++i) {
    const auto begin = number(places, i);
    const auto length = number(lengths, i);
    if (!begin || !length || *begin + *length > file.size()) return false;
  }
  return true;
}

// The size of the whole file, as pages lie in any order.
std::optional<size_t> Length(std::string_view file) {
  const auto directory = TiffDirectory::Read(ImageBytes(file));
  if (!directory) return std::nullopt;
  const bool is_tiled = directory->Count(kTileOffsets) > 0;
  const auto places = directory->Find(is_tiled ? kTileOffsets : kStripOffsets);
  const auto lengths = directory->Find(is_tiled ? kTileByteCounts : kStripByteCounts);
  const bool is_whole = places && lengths && AreInFile(*places, *lengths, directory->order(), file);
  return is_whole ? std::optional(file.size()) : std::nullopt;
}

void ClearOrientation(std::span<char> file) {
  const auto directory = TiffDirectory::Read(ImageBytes({file.data(), file.size()}));
  const auto entry = directory ? directory->Find(kTiffOrientation) : std::nullopt;
  if (!entry || !directory->Number(kTiffOrientation)) return;  // value is not in the file
  const auto number = file.subspan(entry->begin, entry->bytes_each);
  std::ranges::fill(number, '\0');
  (directory->order() == ByteOrder::kBigEndian ? number.back() : number.front()) = 1;
}

// EXIF 2.32, section 4.6.
constexpr std::uint64_t kExifDirectory = 0x8769;
constexpr std::uint64_t kFocalLength = 0x920A, kFocalLengthIn35mmFilm = 0xA405;
constexpr std::uint64_t kPixelXDimension = 0xA002, kPixelYDimension = 0xA003;
constexpr std::uint64_t kFocalPlaneXResolution = 0xA20E, kFocalPlaneResolutionUnit = 0xA210;

constexpr double kFilmDiagonalMm = 43.267;

// Size of the image that the camera wrote.
std::optional<ImageSize> SizeInExif(const TiffDirectory& exif) {
  const auto width = exif.Number(kPixelXDimension).value_or(0);
  const auto height = exif.Number(kPixelYDimension).value_or(0);
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

std::optional<double> FromSensor(const TiffDirectory& exif, const ImageSize& written) {
  constexpr std::uint64_t kInch = 2, kCentimetre = 3;
  const auto focal_mm = exif.Ratio(kFocalLength);
  const auto pixels_per_unit = exif.Ratio(kFocalPlaneXResolution);
  const auto unit = exif.Number(kFocalPlaneResolutionUnit).value_or(kInch);
  if (!focal_mm || !pixels_per_unit || (unit != kInch && unit != kCentimetre)) return std::nullopt;
  return *focal_mm * *pixels_per_unit / (unit == kInch ? 25.4 : 10.0) / Diagonal(written);
}

}  // namespace

constexpr ImageFormat kTiffFormat = {
    "TIFF", &IsTiff, &Header, &Length, "with all of its strips or tiles", &ClearOrientation};

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
  const auto first = TiffDirectory::Read(ImageBytes(exif));
  const auto directory = first ? first->SubDirectory(kExifDirectory) : std::nullopt;
  if (!directory || stored.width <= 0 || stored.height <= 0) return std::nullopt;
  const auto written = SizeInExif(*directory);
  const bool is_cropped =
      written && std::abs(AspectOf(*written) / AspectOf(stored) - 1.0) > kMaxAspectChange;
  if (is_cropped) return std::nullopt;
  const auto film_mm = directory->Number(kFocalLengthIn35mmFilm).value_or(0);
  const auto focal = film_mm > 0 ? std::optional(static_cast<double>(film_mm) / kFilmDiagonalMm)
                                 : FromSensor(*directory, written.value_or(stored));
  return focal && *focal >= kMin && *focal <= kMax ? focal : std::nullopt;
}

}  // namespace soslam

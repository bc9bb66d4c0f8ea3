// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/image/tiff_file.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace soslam {
namespace {

using namespace std::string_view_literals;

constexpr std::uint64_t kTiffOrientation = 274;

std::optional<ByteOrder> ReadOrder(std::string_view head) {
  if (head == "II*\0"sv) return ByteOrder::kLittleEndian;
  if (head == "MM\0*"sv) return ByteOrder::kBigEndian;
  return std::nullopt;
}

// A tag of a TIFF file and its numbers.
struct TiffEntry {
  std::uint64_t tag;
  size_t bytes_each;  // bytes per number; 0 if they are not unsigned integers
  bool is_ratio;      // each value is a RATIONAL: two unsigned integers of 4 bytes
  bool is_text;
  std::uint64_t count;  // as the file claims
  std::uint64_t begin;  // offset in the file
};

// A directory of a TIFF file (TIFF 6.0, section 2). EXIF data are a TIFF file within another.
class TiffDirectory {
 public:
  // The first directory. None if the file is no TIFF file, or ends before the directory does.
  static std::optional<TiffDirectory> Read(const ImageBytes& file) {
    const auto order = ReadOrder(file.UpTo(0, 4));
    if (!order) return std::nullopt;
    const auto begin = file.NumberAt(4, 4, *order);
    return begin ? ReadAt(*begin, *order, file) : std::nullopt;
  }

  // The directory that an entry with this tag points to, as EXIF's own; none as for Read.
  std::optional<TiffDirectory> SubDirectory(std::uint64_t tag, std::uint64_t index = 0) const {
    const auto begin = Number(tag, index);
    return begin ? ReadAt(*begin, order_, file_) : std::nullopt;
  }

  // The directory of the next image; none also after the last one.
  std::optional<TiffDirectory> Next() const {
    const auto begin = file_.NumberAt(end_, 4, order_);
    return begin && *begin > 0 ? ReadAt(*begin, order_, file_) : std::nullopt;
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

  // A number of an entry; none if it has fewer, or this one is not in the file.
  std::optional<std::uint64_t> Number(const TiffEntry& entry, std::uint64_t index) const {
    if (index >= entry.count) return std::nullopt;
    return file_.NumberAt(entry.begin + index * entry.bytes_each, entry.bytes_each, order_);
  }

  // A number of the first entry with this tag; none as for Find, or if it is not in the file.
  std::optional<std::uint64_t> Number(std::uint64_t tag, std::uint64_t index = 0) const {
    const auto entry = Find(tag);
    return entry ? Number(*entry, index) : std::nullopt;
  }

  // At most `most` characters of the first entry with this tag; empty if there is none.
  std::string Text(std::uint64_t tag, size_t most) const {
    const auto found = std::ranges::find(entries_, tag, &TiffEntry::tag);
    if (found == entries_.end() || !found->is_text) return "";
    return file_.UpTo(found->begin, std::min<size_t>(found->count, most));
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
    constexpr std::uint64_t kAscii = 2, kRational = 5;
    // Bytes of types that are unsigned integers: BYTE, SHORT, LONG, IFD (place of a directory).
    constexpr size_t kBytesEach[] = {0, 1, 0, 2, 4, 0, 0, 0, 0, 0, 0, 0, 0, 4};
    constexpr size_t kEntrySize = 12;  // tag 2, type 2, count 4, value or its offset 4
    const auto count = file.NumberAt(begin, 2, order);
    const auto bytes = count ? file.At(begin + 2, *count * kEntrySize) : std::nullopt;
    if (!bytes) return std::nullopt;
    TiffDirectory directory(file, order);
    directory.end_ = begin + 2 + bytes->size();
    for (size_t at = 0; at < bytes->size(); at += kEntrySize) {
      const auto number = [&](size_t offset, size_t size) {
        return NumberFromBytes(std::string_view(*bytes).substr(at + offset, size), order);
      };
      const std::uint64_t type = number(2, 2);
      TiffEntry entry{number(0, 2),      type < std::size(kBytesEach) ? kBytesEach[type] : 0,
                      type == kRational, type == kAscii,
                      number(4, 4),      begin + 2 + at + 8};
      const std::uint64_t length = entry.is_text ? entry.count : entry.bytes_each * entry.count;
      if (entry.is_ratio || length > 4) entry.begin = number(8, 4);
      directory.entries_.push_back(entry);
    }
    return directory;
  }

  ImageBytes file_;
  ByteOrder order_;
  std::uint64_t end_ = 0;  // of the entries in the file
  std::vector<TiffEntry> entries_;
};

std::optional<int> OrientationIn(const TiffDirectory& directory) {
  const auto orientation = directory.Number(kTiffOrientation);
  if (!orientation || *orientation < 1 || *orientation > 8) return std::nullopt;
  return static_cast<int>(*orientation);
}

// EXIF 2.32, section 4.6.
constexpr std::uint64_t kExifDirectory = 0x8769;
constexpr std::uint64_t kDateTimeOriginal = 0x9003, kSubSecTimeOriginal = 0x9291;
constexpr std::uint64_t kFocalLength = 0x920A, kFocalLengthIn35mmFilm = 0xA405;
constexpr std::uint64_t kPixelXDimension = 0xA002, kPixelYDimension = 0xA003;
constexpr std::uint64_t kFocalPlaneXResolution = 0xA20E, kFocalPlaneResolutionUnit = 0xA210;

// Cameras without a clock write zeros or blanks.
std::string TimeTakenIn(const TiffDirectory& first) {
  const auto exif = first.SubDirectory(kExifDirectory);
  if (!exif) return "";
  const auto digits = [&](std::uint64_t tag, size_t most) {
    std::string text = exif->Text(tag, most);
    std::erase_if(text, [](char c) { return c < '0' || c > '9'; });
    return text;
  };
  const std::string time =
      digits(kDateTimeOriginal, std::string_view("2024:01:31 23:59:59").size());
  if (time.size() != 14 || time.starts_with("0000")) return "";
  return time + "." + digits(kSubSecTimeOriginal, 9);
}

// TIFF 6.0, section 8 and "Tiled images".
constexpr std::uint64_t kWidth = 256, kHeight = 257, kBitsPerSample = 258, kCompression = 259;
constexpr std::uint64_t kStripOffsets = 273, kStripByteCounts = 279;
constexpr std::uint64_t kTileWidth = 322, kTileHeight = 323, kTileOffsets = 324;
constexpr std::uint64_t kTileByteCounts = 325;

bool IsTiff(std::string_view first_bytes) {
  return ReadOrder(first_bytes.substr(0, 4)).has_value();
}

// Header of the first page. libtiff, too, takes the first of two entries with the same tag; it
// allocates whole tiles. What is packed in an unknown way becomes black without an error.
std::optional<ImageHeader> Header(const ImageBytes& file) {
  constexpr std::uint64_t kMaxTileSide = 1 << 13;
  constexpr std::uint64_t kBits[] = {1, 8, 16};
  constexpr std::uint64_t kCompressions[] = {1, 5, 7, 8, 32773, 32946};  // none, LZW, JPEG, ...
  const auto directory = TiffDirectory::Read(file);
  if (!directory) return std::nullopt;
  const auto is_at_most = [&](std::uint64_t tag, std::uint64_t most) {
    return directory->Count(tag) == 0 || directory->Number(tag).value_or(most + 1) <= most;
  };
  const auto width = directory->Number(kWidth);
  const auto height = directory->Number(kHeight);
  const auto is_one_of = [&](std::uint64_t tag, const auto& known) {
    const auto number = directory->Count(tag) == 0 ? 1 : directory->Number(tag).value_or(0);
    return std::ranges::count(known, number) > 0;
  };
  if (!width || !height || !is_one_of(kBitsPerSample, kBits) ||
      !is_one_of(kCompression, kCompressions) || !is_at_most(kTileWidth, kMaxTileSide) ||
      !is_at_most(kTileHeight, kMaxTileSide)) {
    return std::nullopt;
  }
  return ImageHeader{{static_cast<std::int64_t>(*width), static_cast<std::int64_t>(*height)},
                     OrientationIn(*directory).value_or(1),
                     std::nullopt,
                     TimeTakenIn(*directory)};
}

// TIFF 6.0, sections 8 and 22; TIFF/EP (ISO 12234-2) and DNG 1.6.
constexpr std::uint64_t kNewSubfileType = 254, kThumbnailJpeg = 513, kSubImages = 330;
constexpr std::uint64_t kPhotometric = 262, kDngVersion = 50706;

// True for pixels that are still those of the sensor.
bool IsOfSensor(const TiffDirectory& image) {
  constexpr std::uint64_t kColourFilterArray = 32803, kLinearRaw = 34892;
  const std::uint64_t photometric = image.Number(kPhotometric).value_or(0);
  return image.Count(kDngVersion) > 0 || photometric == kColourFilterArray ||
         photometric == kLinearRaw;
}

// True for thumbnails, smaller copies and masks of another image in the file.
bool IsSecondary(const TiffDirectory& image) {
  constexpr std::uint64_t kIsReduced = 1, kIsMask = 4;
  return (image.Number(kNewSubfileType).value_or(0) & (kIsReduced | kIsMask)) != 0 ||
         image.Count(kThumbnailJpeg) > 0;
}

// The photo of a RAW file is in a directory below that of a thumbnail, or beside it; pages follow
// each other. Thumbnails, smaller copies and masks after the first image do not matter.
std::optional<OtherContent> Other(const ImageBytes& file) {
  const auto first = TiffDirectory::Read(file);
  if (!first) return std::nullopt;
  const bool is_thumbnail = IsSecondary(*first);
  const bool has_photo_below = is_thumbnail && first->Count(kSubImages) > 0;
  const bool is_cr2 = file.UpTo(8, 4) == "CR\2\0"sv;  // Canon's, whose name follows the header
  if (IsOfSensor(*first) || is_cr2 || has_photo_below) return OtherContent::kRawPhoto;
  int unseen = 64;  // images at most: they may form a circle
  for (auto image = *first;;) {
    for (std::uint64_t i = 0; unseen > 0; ++i, --unseen) {
      const auto below = image.SubDirectory(kSubImages, i);
      if (!below) break;
      if (!IsSecondary(*below) || IsOfSensor(*below)) return OtherContent::kRawPhoto;
    }
    auto next = image.Next();
    if (!next) return std::nullopt;
    if (is_thumbnail || IsOfSensor(*next)) return OtherContent::kRawPhoto;
    if (!IsSecondary(*next) || --unseen <= 0) return OtherContent::kSeveralImages;
    image = std::move(*next);
  }
}

// The size of the whole file, if all strips or tiles are in it, as they lie in any order. Decoders
// leave out those of separate planes without an error.
std::optional<size_t> Length(std::string_view file) {
  const auto directory = TiffDirectory::Read(ImageBytes(file));
  if (!directory) return std::nullopt;
  const bool is_tiled = directory->Count(kTileOffsets) > 0;
  const auto places = directory->Find(is_tiled ? kTileOffsets : kStripOffsets);
  const auto lengths = directory->Find(is_tiled ? kTileByteCounts : kStripByteCounts);
  if (!places || !lengths || places->count != lengths->count) return std::nullopt;
  for (std::uint64_t i = 0; i < places->count; ++i) {
    const auto begin = directory->Number(*places, i);
    const auto length = directory->Number(*lengths, i);
    if (!begin || !length || *begin + *length > file.size()) return std::nullopt;
  }
  return file.size();
}

void ClearOrientation(std::span<char> file) {
  const auto directory = TiffDirectory::Read(ImageBytes({file.data(), file.size()}));
  const auto entry = directory ? directory->Find(kTiffOrientation) : std::nullopt;
  if (!entry || !directory->Number(kTiffOrientation)) return;  // value is not in the file
  const auto number = file.subspan(entry->begin, entry->bytes_each);
  std::ranges::fill(number, '\0');
  (directory->order() == ByteOrder::kBigEndian ? number.back() : number.front()) = 1;
}

constexpr double kFilmDiagonalMm = 43.267;

// Longer side over shorter side, which scaling and turning leave as they are.
double ComputeAspect(const ImageSize& size) {
  const auto [shorter, longer] = std::minmax(size.width, size.height);
  return static_cast<double>(longer) / static_cast<double>(shorter);
}

}  // namespace

std::optional<int> ExifOrientation(std::string_view exif) {
  const auto directory = TiffDirectory::Read(ImageBytes(exif));
  return directory ? OrientationIn(*directory) : std::nullopt;
}

std::string ExifTimeTaken(std::string_view exif) {
  const auto directory = TiffDirectory::Read(ImageBytes(exif));
  return directory ? TimeTakenIn(*directory) : "";
}

constexpr ImageFormat kTiffFormat = {
    "TIFF", &IsTiff, &Header, &Length, "with all of its strips or tiles", &ClearOrientation,
    &Other};

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
  const auto width = directory->Number(kPixelXDimension).value_or(0);
  const auto height = directory->Number(kPixelYDimension).value_or(0);
  ImageSize written = stored;  // the size that the camera wrote
  if (width > 0 && height > 0) {
    written = {static_cast<std::int64_t>(width), static_cast<std::int64_t>(height)};
  }
  const bool is_cropped =
      std::abs(ComputeAspect(written) / ComputeAspect(stored) - 1.0) > kMaxAspectChange;
  if (is_cropped) return std::nullopt;
  constexpr std::uint64_t kInch = 2, kCentimetre = 3;
  const auto film_mm = directory->Number(kFocalLengthIn35mmFilm).value_or(0);
  const auto focal_mm = directory->Ratio(kFocalLength);
  const auto pixels_per_unit = directory->Ratio(kFocalPlaneXResolution);
  const auto unit = directory->Number(kFocalPlaneResolutionUnit).value_or(kInch);
  std::optional<double> focal;
  if (film_mm > 0) {
    focal = static_cast<double>(film_mm) / kFilmDiagonalMm;
  } else if (focal_mm && pixels_per_unit && (unit == kInch || unit == kCentimetre)) {
    const double diagonal =
        std::hypot(static_cast<double>(written.width), static_cast<double>(written.height));
    focal = *focal_mm * *pixels_per_unit / (unit == kInch ? 25.4 : 10.0) / diagonal;
  }
  return focal && *focal >= kMin && *focal <= kMax ? focal : std::nullopt;
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "image/tiff_directory.h"

#include <algorithm>

namespace soslam {
namespace {

using namespace std::string_view_literals;

constexpr size_t kEntrySize = 12;  // tag 2, type 2, count 4, value or its offset 4

std::optional<ByteOrder> OrderOf(std::string_view head) {
  if (head == "II*\0"sv) return ByteOrder::kLittleEndian;
  if (head == "MM\0*"sv) return ByteOrder::kBigEndian;
  return std::nullopt;
}

// Bytes per number of type BYTE, SHORT or LONG; 0 for other types.
size_t BytesEach(std::uint64_t type) {
  constexpr size_t kBytes[] = {0, 1, 0, 2, 4};
  return type < std::size(kBytes) ? kBytes[type] : 0;
}

TiffEntry ParseEntry(std::string_view bytes, std::uint64_t begin, ByteOrder order) {
  const auto number = [&](size_t at, size_t count) {
    return NumberFromBytes(bytes.substr(at, count), order);
  };
  TiffEntry entry{number(0, 2), BytesEach(number(2, 2)), number(4, 4), begin + 8};
  if (entry.bytes_each * entry.count > 4) entry.begin = number(8, 4);
  return entry;
}

}  // namespace

std::optional<TiffDirectory> TiffDirectory::Read(const ImageBytes& file) {
  const auto order = OrderOf(file.UpTo(0, 4));
  if (!order) return std::nullopt;
  const auto begin = file.NumberAt(4, 4, *order);
  const auto count = begin ? file.NumberAt(*begin, 2, *order) : std::nullopt;
  const auto bytes = count ? file.At(*begin + 2, *count * kEntrySize) : std::nullopt;
  if (!bytes) return std::nullopt;
  std::vector<TiffEntry> entries;
  for (size_t at = 0; at < bytes->size(); at += kEntrySize) {
    entries.push_back(
        ParseEntry(std::string_view(*bytes).substr(at, kEntrySize), *begin + 2 + at, *order));
  }
  return TiffDirectory(*order, std::move(entries));
}

std::optional<TiffEntry> TiffDirectory::Find(std::uint64_t tag) const {
  const auto found = std::ranges::find(entries_, tag, &TiffEntry::tag);
  if (found == entries_.end() || found->bytes_each == 0 || found->count == 0) return std::nullopt;
  return *found;
}

std::ptrdiff_t TiffDirectory::Count(std::uint64_t tag) const {
  return std::ranges::count(entries_, tag, &TiffEntry::tag);
}

std::optional<std::uint64_t> TiffDirectory::Number(std::uint64_t tag,
                                                   const ImageBytes& file) const {
  const auto entry = Find(tag);
  return entry ? file.NumberAt(entry->begin, entry->bytes_each, order_) : std::nullopt;
}

std::optional<int> ExifOrientation(const TiffDirectory& exif, const ImageBytes& file) {
  const auto orientation = exif.Number(kTiffOrientation, file);
  if (!orientation || *orientation < 1 || *orientation > 8) return std::nullopt;
  return static_cast<int>(*orientation);
}

std::optional<int> ExifOrientation(std::string_view exif) {
  const ImageBytes file(exif);
  const auto directory = TiffDirectory::Read(file);
  return directory ? ExifOrientation(*directory, file) : std::nullopt;
}

}  // namespace soslam

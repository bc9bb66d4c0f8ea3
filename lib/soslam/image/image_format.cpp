// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/image/image_format.h"

#include <algorithm>
#include <fstream>
#include <memory>
#include <set>

#include "soslam/base/paths.h"
#include "soslam/base/text.h"

namespace soslam {

bool HasNameOfRawPhoto(const std::filesystem::path& path) {
  static const std::set<std::string> kExtensions = {
      ".3fr", ".arw", ".cr2", ".cr3", ".crw", ".dcr", ".dng", ".erf", ".gpr",
      ".iiq", ".kdc", ".mef", ".mos", ".mrw", ".nef", ".nrw", ".orf", ".pef",
      ".raf", ".rw2", ".rwl", ".sr2", ".srf", ".srw", ".x3f"};
  return kExtensions.contains(LowerCase(path.extension().string()));
}

bool IsRawPhoto(const std::filesystem::path& path) {
  return FindOtherContent(path, ImageBytes::OfFile(path)) == OtherContent::kRawPhoto;
}

std::optional<OtherContent> FindOtherContent(const std::filesystem::path& path,
                                             const ImageBytes& file) {
  using namespace std::string_view_literals;
  // Begin of RAW photos that are no TIFF files: RAF, ORF (three), RW2, CRW, X3F, MRW.
  constexpr std::string_view kSignatures[] = {"FUJIFILMCCD"sv, "IIRO"sv,  "IIRS"sv,
                                              "MMOR"sv,        "IIU\0"sv, "II\x1a\0\0\0HEAP"sv,
                                              "FOVb"sv,        "\0MRM"sv};
  const std::string first_bytes = file.UpTo(0, kSignatureSize);
  const bool has_signature = std::ranges::any_of(
      kSignatures, [&](std::string_view signature) { return first_bytes.starts_with(signature); });
  const bool is_cr3 = first_bytes.ends_with("ftypcrx ");
  if (HasNameOfRawPhoto(path) || has_signature || is_cr3) {
    return OtherContent::kRawPhoto;
  }
  const ImageFormat* format = FindImageFormat(first_bytes);
  const bool can_have_other = format != nullptr && format->other_content != nullptr;
  return can_have_other ? format->other_content(file) : std::nullopt;
}

std::optional<ImageHeader> ReadImageHeader(const std::filesystem::path& path) {
  if (!IsFile(path)) return std::nullopt;
  const ImageBytes file = ImageBytes::OfFile(path);
  const ImageFormat* format = FindImageFormat(file.UpTo(0, kSignatureSize));
  if (format == nullptr || FindOtherContent(path, file)) return std::nullopt;
  return format->header(file);
}

std::uint64_t NumberFromBytes(std::string_view bytes, ByteOrder order) {
  std::uint64_t number = 0;
  for (size_t i = 0; i < bytes.size(); ++i) {
    const char byte = bytes[order == ByteOrder::kBigEndian ? i : bytes.size() - 1 - i];
    number = number << 8 | static_cast<unsigned char>(byte);
  }
  return number;
}

ImageBytes::ImageBytes(std::string_view bytes)
    : read_([bytes](std::uint64_t begin, size_t count) {
        return begin < bytes.size() ? std::string(bytes.substr(begin, count)) : std::string();
      }) {}

ImageBytes ImageBytes::OfFile(const std::filesystem::path& path) {
  const auto stream = std::make_shared<std::ifstream>(path, std::ios::binary);
  return ImageBytes([stream](std::uint64_t begin, size_t count) {
    std::string bytes(count, '\0');
    stream->clear();  // clears an earlier end of file
    stream->seekg(static_cast<std::streamoff>(begin));
    stream->read(bytes.data(), static_cast<std::streamsize>(count));
    bytes.resize(static_cast<size_t>(std::max<std::streamsize>(0, stream->gcount())));
    return bytes;
  });
}

std::optional<std::string> ImageBytes::At(std::uint64_t begin, size_t count) const {
  std::string bytes = read_(begin, count);
  if (bytes.size() < count) return std::nullopt;
  return bytes;
}

std::optional<std::uint64_t> ImageBytes::NumberAt(std::uint64_t begin, size_t count,
                                                  ByteOrder order) const {
  const auto bytes = At(begin, count);
  if (!bytes) return std::nullopt;
  return NumberFromBytes(*bytes, order);
}

const ImageFormat* FindImageFormat(std::string_view first_bytes) {
  for (const ImageFormat* format :
       {&kJpegFormat, &kPngFormat, &kWebpFormat, &kBmpFormat, &kTiffFormat}) {
    if (format->has_signature(first_bytes)) return format;
  }
  return nullptr;
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/image/file_kind.h"

#include <fmt/format.h>

#include "soslam/base/error.h"
#include "soslam/base/text.h"
#include "soslam/image/image_format.h"

namespace soslam {
namespace {

using namespace std::string_view_literals;

struct Signature {
  std::string_view bytes;
  const char* kind;
};
constexpr Signature kSignatures[] = {
    {"\x89HDF\r\n\x1a\n"sv, "an HDF5 file"},
    {"version https://git-lfs.github.com/spec/"sv,
     "a Git LFS pointer, not the file itself (git lfs pull fetches it)"},
    {"\xff\xfe"sv, "UTF-16 text"},
    {"\xfe\xff"sv, "UTF-16 text"},
    {"\x1f\x8b"sv, "a gzip archive"},
    {"\x28\xb5\x2f\xfd"sv, "a zstd archive"},
    {"\xfd\x37zXZ\0"sv, "an xz archive"},
    {"BZh91AY&SY"sv, "a bzip2 archive"},
    {"PK\x03\x04"sv, "a zip archive"},
    {"7z\xbc\xaf\x27\x1c"sv, "a 7z archive"},
    {"\x93NUMPY"sv, "a NumPy array"},
    {"SQLite format 3\0"sv, "a SQLite database"},
    {"#ROSBAG V"sv, "a ROS bag"},
    {"%PDF-"sv, "a PDF document"},
    {"GIF89a"sv, "a GIF image"},
    {"GIF87a"sv, "a GIF image"},
    {"\x1a\x45\xdf\xa3"sv, "a video (Matroska, WebM)"},
};

constexpr const char* kJson = "JSON";
constexpr const char* kXml = "XML";

}  // namespace

std::string FileKind(std::string_view first_bytes) {
  first_bytes = first_bytes.substr(0, kFileKindSize);
  for (const auto& [bytes, kind] : kSignatures) {
    if (first_bytes.starts_with(bytes)) return kind;
  }
  if (first_bytes.size() >= 12 && first_bytes.substr(4, 4) == "ftyp") {
    // The brand after the size and name of the first box (ISO/IEC 14496-12).
    for (const auto& image : {"heic"sv, "heix"sv, "mif1"sv, "msf1"sv, "avif"sv}) {
      if (first_bytes.substr(8, 4) == image) return "an HEIF image (HEIC, AVIF)";
    }
    return "a video (MP4, MOV)";
  }
  const ImageFormat* const image = FindImageFormat(first_bytes.substr(0, kSignatureSize));
  const bool may_be_text = image == &kBmpFormat && first_bytes.find('\0') == first_bytes.npos;
  if (image != nullptr && !may_be_text) return fmt::format("a {} image", image->name);
  if (first_bytes.starts_with("\xEF\xBB\xBF"sv)) first_bytes.remove_prefix(3);
  const size_t begin = first_bytes.find_first_not_of(" \t\r\n");
  if (begin == first_bytes.npos) return "";
  const std::string text = LowerCase(std::string(first_bytes.substr(begin)));
  if (text.starts_with("<!doctype html") || text.starts_with("<html")) {
    return "an HTML page, as servers send it in place of a file (download the file again)";
  }
  // Annotations of images often have no declaration.
  if (text.starts_with("<?xml") || text.starts_with("<annotation")) return kXml;
  return text.front() == '{' || text.front() == '[' ? kJson : "";
}

std::string KindOfFile(const std::filesystem::path& path) {
  return FileKind(ImageBytes::OfFile(path).UpTo(0, kFileKindSize));
}

void CheckIsText(std::string_view first_bytes, const std::string& file, const char* expected) {
  const std::string kind = FileKind(first_bytes);
  if (kind.empty() || kind == kJson || kind == kXml) return;
  throw InputError(fmt::format("{}: is {}; expected {}", file, kind, expected));
}

}  // namespace soslam

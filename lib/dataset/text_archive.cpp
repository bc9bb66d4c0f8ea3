// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/text_archive.h"

#include <archive.h>
#include <archive_entry.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>

#include "base/error.h"
#include "base/run_log.h"

namespace soslam {
namespace {

struct FreeArchive {
  void operator()(archive* opened) const { archive_read_free(opened); }
};
using ArchivePointer = std::unique_ptr<archive, FreeArchive>;

[[noreturn]] void Refuse(const std::filesystem::path& path, archive* opened) {
  const char* reason = archive_error_string(opened);
  throw InputError(fmt::format("{}: cannot be read: {}; expected an archive (.tar.gz, .tar, .zip)",
                               path.string(), reason == nullptr ? "damaged" : reason));
}

ArchivePointer Open(const std::filesystem::path& path) {
  RecordInput(path);
  constexpr size_t kBlock = 1 << 16;  // bytes
  ArchivePointer opened(archive_read_new());
  // Not "all", because the library runs external programs for some formats.
  archive_read_support_filter_gzip(opened.get());
  archive_read_support_filter_bzip2(opened.get());
  archive_read_support_filter_xz(opened.get());
  archive_read_support_filter_zstd(opened.get());
  archive_read_support_format_tar(opened.get());
  // Not the streaming zip reader, which may search for the next entry endlessly.
  archive_read_support_format_zip_seekable(opened.get());
  if (archive_read_open_filename(opened.get(), path.c_str(), kBlock) != ARCHIVE_OK) {
    Refuse(path, opened.get());
  }
  return opened;
}

// Limits above any detector's boxes of a recording and any archive of them; larger ones are
// decompression bombs.
constexpr std::int64_t kMaxTextBytes = std::int64_t{64} << 20;
constexpr std::int64_t kMaxUnpackedBytes = std::int64_t{256} << 20;

void CheckBytes(std::int64_t bytes, std::int64_t most, const std::filesystem::path& path) {
  if (bytes <= most) return;
  throw InputError(fmt::format("{}: unpacks to {} bytes or more; expected at most {} of text files",
                               path.string(), bytes, most));
}

// Reads the entry that was opened last.
std::string ReadEntry(const std::filesystem::path& path, std::int64_t max_bytes, archive* opened) {
  std::string text;
  std::array<char, 1 << 16> block;
  for (;;) {
    const la_ssize_t size = archive_read_data(opened, block.data(), block.size());
    if (size < 0) Refuse(path, opened);
    if (size == 0) return text;
    text.append(block.data(), static_cast<size_t>(size));
    CheckBytes(static_cast<std::int64_t>(text.size()), max_bytes, path);
  }
}

}  // namespace

std::vector<ArchivedText> ReadTextArchive(
    const std::filesystem::path& path,
    const std::function<bool(const std::filesystem::path&)>& wanted) {
  const ArchivePointer opened = Open(path);
  std::vector<ArchivedText> texts;
  std::int64_t bytes_left = kMaxTextBytes;
  for (;;) {
    archive_entry* entry = nullptr;
    const int status = archive_read_next_header(opened.get(), &entry);
    if (status == ARCHIVE_EOF) break;
    if (status < ARCHIVE_WARN) Refuse(path, opened.get());
    // Skipped entries are decompressed, too, to find the next one.
    CheckBytes(archive_entry_size(entry), kMaxUnpackedBytes, path);
    CheckBytes(archive_filter_bytes(opened.get(), 0), kMaxUnpackedBytes, path);
    // Nested compression makes a few bytes expand endlessly. No compression counts as one filter.
    if (archive_filter_count(opened.get()) > 2) {
      throw InputError(path.string() + ": is packed more than once; expected .tar.gz, .tar, .zip");
    }
    const char* name = archive_entry_pathname(entry);
    if (name == nullptr || !wanted(name)) continue;
    texts.push_back({name, ReadEntry(path, bytes_left, opened.get())});
    bytes_left -= static_cast<std::int64_t>(texts.back().text.size());
  }
  std::ranges::sort(texts, {}, &ArchivedText::name);
  return texts;
}

}  // namespace soslam

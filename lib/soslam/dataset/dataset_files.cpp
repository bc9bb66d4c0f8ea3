// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/dataset/dataset_files.h"

#include <archive.h>
#include <archive_entry.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <memory>

#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/image/file_kind.h"
#include "soslam/system/run_log.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

// The entries that the iterator gives, sorted by name. Throws InputError when it cannot list them.
template <typename Iterator>
std::vector<fs::path> Sorted(const fs::path& folder) {
  std::vector<fs::path> entries;
  try {
    for (const fs::directory_entry& entry : Iterator(folder)) entries.push_back(entry.path());
  } catch (const fs::filesystem_error& error) {
    throw InputError(fmt::format("{}: cannot be listed ({}); expected a folder that can be read",
                                 folder.string(), error.code().message()));
  }
  std::ranges::sort(entries);
  return entries;
}

}  // namespace

std::vector<fs::path> DatasetFiles::All() const {
  std::vector<fs::path> files;
  if (IsFolder(detections)) {
    for (const fs::path& entry : Sorted<fs::recursive_directory_iterator>(detections)) {
      const fs::path name = entry.filename();
      const bool is_hidden = name.string().starts_with('.');  // created by macOS
      if (IsFile(entry) && name.extension() == ".txt" && !is_hidden) files.push_back(entry);
    }
  } else {
    files.push_back(detections);
  }
  files.push_back(trajectory);
  if (groundtruth && *groundtruth != trajectory) files.push_back(*groundtruth);
  for (const auto& file : {images, camera, planes, class_names, objects}) {
    if (file && std::ranges::find(files, *file) == files.end()) files.push_back(*file);
  }
  return files;
}

DatasetFiles FindDatasetFiles(const fs::path& folder, const ImportOptions& options) {
  const FolderOptions usual;
  const FolderOptions& names = options.folder;
  std::vector<std::string> missing;
  const auto if_present = [&](const std::string& name) {
    const bool is_present = !name.empty() && Exists(folder / name);
    return is_present ? std::optional(folder / name) : std::nullopt;
  };
  const auto required = [&](const std::string& name) {
    if (!Exists(folder / name)) missing.push_back(name);
    return folder / name;
  };
  const auto required_if_named = [&](const std::string& name) {
    return name.empty() ? std::nullopt : std::optional(required(name));
  };
  const auto trajectory = [&](const std::string& name, const std::string& usual_name) {
    return name == usual_name ? if_present(name) : required_if_named(name);
  };
  DatasetFiles files;
  files.images = required_if_named(names.images);
  if (names.camera.empty()) {
    files.camera = required(names.camera_file.empty() ? "camera.json" : names.camera_file);
  }
  files.planes = if_present("planes.json");
  files.detections = required(options.detections.empty() ? "detections.csv" : options.detections);
  files.class_names = required_if_named(names.class_names);
  files.objects = if_present("objects.json");
  const auto odometry = trajectory(names.odometry, usual.odometry);
  files.groundtruth = trajectory(names.groundtruth, usual.groundtruth);
  const bool wants_odometry = options.trajectory == TrajectorySource::kOdometry;
  const auto& wanted = wants_odometry ? odometry : files.groundtruth;
  const auto& other = wants_odometry ? files.groundtruth : odometry;
  if (!wanted && !other) {
    missing.push_back(fmt::format("a trajectory ({} or {})", usual.odometry, usual.groundtruth));
  }
  if (!missing.empty()) {
    const bool lacks_boxes = options.detections.empty() && !Exists(files.detections);
    throw InputError(fmt::format(
        "{}: {} {} missing; expected a dataset folder of format {}{}", folder.string(),
        fmt::join(missing, ", "), missing.size() == 1 ? "is" : "are",
        kDatasetFormatNames[static_cast<size_t>(options.format)],
        lacks_boxes ? "; boxes of other programs are given by detections and detections_format"
                    : ""));
  }
  files.trajectory = wanted ? *wanted : *other;
  files.trajectory_is_fallback = !wanted;
  return files;
}

std::vector<fs::path> FolderEntries(const fs::path& folder) {
  return Sorted<fs::directory_iterator>(folder);
}

namespace {

struct FreeArchive {
  void operator()(archive* opened) const { archive_read_free(opened); }
};

[[noreturn]] void Refuse(const std::filesystem::path& path, archive* opened) {
  const char* reason = archive_error_string(opened);
  const std::string kind = KindOfFile(path);
  throw InputError(
      fmt::format("{}: {}; expected an archive (.tar.gz, .tar, .zip)", path.string(),
                  kind.empty() || kind.ends_with("archive")
                      ? fmt::format("cannot be read: {}", reason == nullptr ? "damaged" : reason)
                      : "is " + kind));
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
  constexpr size_t kBlock = 1 << 16;  // bytes
  RecordInput(path);
  const std::unique_ptr<archive, FreeArchive> opened(archive_read_new());
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

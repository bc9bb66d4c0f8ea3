// SPDX-License-Identifier: BSD-3-Clause
#include "synthesis/dataset_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>

#include "base/error.h"
#include "base/file_kind.h"
#include "base/paths.h"
#include "base/run_log.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

bool IsSynthesised(const fs::path& folder) {
  std::ifstream readme(folder / "README.md");
  std::string first_line;
  return std::getline(readme, first_line) && first_line.rfind(kSynthesisedMark, 0) == 0;
}

[[noreturn]] void Refuse(const fs::path& folder, const std::string& why) {
  throw SettingsError(fmt::format("{}: {}", folder.string(), why));
}

void CheckReplaceable(const fs::path& folder) {
  std::error_code error;
  if (!Exists(folder)) return;
  if (!IsFolder(folder)) Refuse(folder, "is not a folder; expected one, or nothing");
  if (!fs::is_empty(folder, error) && !IsSynthesised(folder)) {
    Refuse(folder, "is not empty and was not written by soslam-synthesise; expected a new folder");
  }
}

fs::path Sibling(const fs::path& folder, const std::string& purpose) {
  return folder.parent_path() /
         fmt::format(".{}.{}-{}", folder.filename().string(), purpose, getpid());
}

// Flushes the disk of a folder; returns the errno of a failure, else 0.
int SyncDiskOf(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return errno;
  const int error = ::syncfs(descriptor) == 0 ? 0 : errno;
  ::close(descriptor);
  return error;
}

// Atomic, so that there is a folder of that name at any moment. Not all file systems support it.
bool Exchange(const fs::path& one, const fs::path& other) {
  return ::renameat2(AT_FDCWD, one.c_str(), AT_FDCWD, other.c_str(), RENAME_EXCHANGE) == 0;
}

}  // namespace

DatasetFolder::DatasetFolder(const fs::path& folder)
    : folder_(PlainPath(folder)), temporary_(Sibling(folder_, "new")) {
  CheckReplaceable(folder_);
  std::error_code error;
  fs::create_directories(folder_.parent_path(), error);
  fs::remove_all(temporary_, error);
  if (!fs::create_directory(temporary_, error)) Refuse(folder_, "cannot be written");
}

DatasetFolder::~DatasetFolder() {
  std::error_code ignored;
  fs::remove_all(temporary_, ignored);
}

void DatasetFolder::Commit() {
  CheckInputsUnchanged();
  CheckReplaceable(folder_);
  if (const int error = SyncDiskOf(temporary_)) {
    Refuse(folder_, fmt::format("cannot be written: {}", std::strerror(error)));
  }
  if (!Exists(folder_) || !Exchange(temporary_, folder_)) Replace();
  for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
    if (entry.is_regular_file()) RecordOutput(entry.path());
  }
}

void DatasetFolder::Replace() {
  const fs::path old = Sibling(folder_, "old");
  std::error_code error;
  const bool replaces = Exists(folder_);
  if (replaces) fs::rename(folder_, old, error);
  if (!error) fs::rename(temporary_, folder_, error);
  if (error) {
    const std::string why = "cannot be written: " + error.message();
    if (replaces && !Exists(folder_)) fs::rename(old, folder_, error);
    Refuse(folder_, why);
  }
  fs::remove_all(old, error);
}

}  // namespace soslam

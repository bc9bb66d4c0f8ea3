// SPDX-License-Identifier: BSD-3-Clause
#include "synthesis/dataset_folder.h"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <string>
#include <system_error>

#include "base/error.h"
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
  if (!fs::exists(folder, error)) return;
  if (!fs::is_directory(folder, error)) Refuse(folder, "is not a folder; expected one, or nothing");
  if (!fs::is_empty(folder, error) && !IsSynthesised(folder)) {
    Refuse(folder, "is not empty and was not written by soslam-synthesise; expected a new folder");
  }
}

// "out/" means "out", so that siblings can be named.
fs::path WithoutTrailingSlash(const fs::path& folder) {
  const fs::path whole = fs::absolute(folder).lexically_normal();
  return whole.has_filename() ? whole : whole.parent_path();
}

fs::path Sibling(const fs::path& folder, const std::string& purpose) {
  return folder.parent_path() /
         fmt::format(".{}.{}-{}", folder.filename().string(), purpose, getpid());
}

}  // namespace

DatasetFolder::DatasetFolder(const fs::path& folder)
    : folder_(WithoutTrailingSlash(folder)), temporary_(Sibling(folder_, "new")) {
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
  const fs::path old = Sibling(folder_, "old");
  std::error_code error;
  const bool replaces = fs::exists(folder_, error);
  if (replaces) fs::rename(folder_, old, error);
  if (!error) fs::rename(temporary_, folder_, error);
  if (error) {
    const std::string why = "cannot be written: " + error.message();
    if (replaces && !fs::exists(folder_, error)) fs::rename(old, folder_, error);
    Refuse(folder_, why);
  }
  fs::remove_all(old, error);
  for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
    if (entry.is_regular_file()) NoteOutput(entry.path());
  }
}

}  // namespace soslam

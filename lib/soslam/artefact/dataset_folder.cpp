// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/artefact/dataset_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <map>
#include <system_error>
#include <utility>
#include <vector>

#include "soslam/artefact/atomic_file.h"
#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/system/hash.h"
#include "soslam/system/run_log.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void Refuse(const fs::path& folder, const std::string& why) {
  throw SettingsError(fmt::format("{}: {}", folder.string(), why));
}

fs::path Sibling(const fs::path& folder, const std::string& purpose) {
  return folder.parent_path() /
         fmt::format(".{}.{}-{}", folder.filename().string(), purpose, getpid());
}

// Digests of files, in the format of sha256sum.
constexpr const char* kSums = "SHA256SUMS";

// Paths, relative to the folder, of all files in it and in its folders that kSums lists: all but
// itself and the record of the last run. Links count as files.
std::vector<fs::path> FilesIn(const fs::path& folder) {
  std::vector<fs::path> names;
  try {
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      fs::path name = entry.path().lexically_relative(folder);
      const bool is_folder = fs::is_directory(entry.symlink_status());
      const bool is_record = name == kSums || name == "run.json" || name == "timing.json";
      if (!is_folder && !is_record) names.push_back(std::move(name));
    }
  } catch (const fs::filesystem_error& error) {
    Refuse(folder, "cannot be listed: " + error.code().message());
  }
  std::ranges::sort(names);
  return names;
}

}  // namespace

DatasetFolder::DatasetFolder(const fs::path& folder, std::string writer)
    : folder_(PlainPath(folder)), writer_(std::move(writer)), temporary_(Sibling(folder_, "new")) {
  CheckReplaceable();
  std::error_code error;
  fs::create_directories(folder_.parent_path(), error);
  fs::remove_all(temporary_, error);
  if (!fs::create_directory(temporary_, error)) Refuse(folder_, "cannot be written");
}

DatasetFolder::~DatasetFolder() {
  std::error_code ignored;
  fs::remove_all(temporary_, ignored);
}

std::string DatasetFolder::Mark() const { return "<!-- Written by " + writer_; }

void DatasetFolder::CheckReplaceable() const {
  if (!Exists(folder_)) return;
  if (!IsFolder(folder_)) Refuse(folder_, "is not a folder; expected one, or nothing");
  const std::vector<fs::path> files = FilesIn(folder_);
  if (files.empty()) return;
  std::ifstream readme(folder_ / "README.md");
  std::string first_line;
  std::getline(readme, first_line);
  if (!first_line.starts_with(Mark()) || !IsFile(folder_ / kSums)) {
    Refuse(folder_, fmt::format("is not empty and was not written by {}, or by an older version; "
                                "expected a new folder",
                                writer_));
  }
  constexpr size_t kDigest = 64, kName = kDigest + 2;
  std::map<fs::path, std::string> sums;  // digests by the name of the file
  std::ifstream listing(folder_ / kSums);
  for (std::string line; std::getline(listing, line);) {
    if (line.size() > kName) sums[line.substr(kName)] = line.substr(0, kDigest);
  }
  for (const fs::path& file : files) {
    const auto sum = sums.find(file);
    const bool is_own = sum != sums.end() && IsFile(folder_ / file);
    if (is_own && Sha256OfFile(folder_ / file) == sum->second) continue;
    Refuse(folder_, fmt::format("has {}, which {} and would be lost; expected a new folder, or one "
                                "as {} left it: move that file elsewhere, or remove the folder",
                                file.string(), is_own ? "was changed" : "is of others", writer_));
  }
}

void DatasetFolder::Write(const std::string& name, std::string_view bytes) const {
  const fs::path path = temporary_ / name;
  std::ofstream file(path, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) throw SettingsError(path.string() + ": cannot be written; is the disk full?");
}

void DatasetFolder::Commit() {
  CheckInputsUnchanged();
  CheckReplaceable();
  std::string sums;
  for (const fs::path& file : FilesIn(temporary_)) {
    sums += fmt::format("{}  {}\n", Sha256OfFile(temporary_ / file), file.string());
  }
  Write(kSums, sums);
  if (const int error = SyncWith(::syncfs, temporary_)) {
    Refuse(folder_, fmt::format("cannot be written: {}", std::strerror(error)));
  }
  // The exchange is atomic, so that there is a folder of that name at any moment. Not all file
  // systems support it.
  const bool is_exchanged = Exists(folder_) && ::renameat2(AT_FDCWD, temporary_.c_str(), AT_FDCWD,
                                                           folder_.c_str(), RENAME_EXCHANGE) == 0;
  if (!is_exchanged) {
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
  for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
    if (entry.is_regular_file()) RecordOutput(entry.path());
  }
}

}  // namespace soslam

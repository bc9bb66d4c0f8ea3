// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz/fuzz_target.h"

#include <algorithm>
#include <stdexcept>

namespace soslam {
namespace {

namespace fs = std::filesystem;

// Whether it is a name like "calib/0001.txt", without "..", of a length that file systems allow.
bool IsInFolder(std::string_view name) {
  constexpr size_t kMaxLength = 100;
  const auto is_allowed = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_' ||
           c == '-' || c == '.' || c == '/';
  };
  return !name.empty() && name.size() < kMaxLength && name.front() != '/' && name.back() != '/' &&
         name.find("..") == name.npos && std::ranges::all_of(name, is_allowed);
}

}  // namespace

fs::path HostileInput::AsFile(const std::string& name) const {
  WriteBytes(files_ / name, std::string(bytes_));
  return files_ / name;
}

fs::path HostileInput::AsFolder() const {
  constexpr std::string_view kMark = "=== ";
  const fs::path folder = files_ / "folder";
  fs::create_directory(folder);
  std::string_view rest = bytes_;
  while (rest.starts_with(kMark)) {
    const size_t name_end = std::min(rest.find('\n'), rest.size());
    const std::string_view name = rest.substr(kMark.size(), name_end - kMark.size());
    rest.remove_prefix(std::min(name_end + 1, rest.size()));
    size_t end = rest.starts_with(kMark) ? 0 : rest.find("\n=== ");
    end = end == rest.npos ? rest.size() : end + (end > 0);  // after the line's end
    if (IsInFolder(name)) {
      std::error_code ignored;  // a file where a folder would have to be
      fs::create_directories((folder / name).parent_path(), ignored);
      WriteBytes(folder / name, std::string(rest.substr(0, end)));
    }
    rest.remove_prefix(end);
  }
  return folder;
}

FuzzTarget::FuzzTarget(const std::string& name, const Read& read) { All().emplace(name, read); }

std::map<std::string, FuzzTarget::Read>& FuzzTarget::All() {
  static std::map<std::string, Read> targets;
  return targets;
}

void CheckNames(const Error& error, const fs::path& path) {
  const std::string message = error.what();
  if (message.find(path.string()) != message.npos) return;
  throw std::logic_error("error that does not name " + path.string() + ": " + message);
}

}  // namespace soslam

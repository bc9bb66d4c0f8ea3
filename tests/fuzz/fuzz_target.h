// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "soslam/base/error.h"
#include "support/temporary_folder.h"

namespace soslam {

// Bytes that nobody vouches for, as files for readers. In TMPDIR; /dev/shm keeps them in memory.
class HostileInput {
 public:
  explicit HostileInput(std::string_view bytes) : bytes_(bytes) {}

  std::filesystem::path AsFile(const std::string& name) const;
  // A folder of several files, each of which begins with a line "=== <path in the folder>". Paths
  // that lead out of the folder are left out.
  std::filesystem::path AsFolder() const;
  // For what is written from it.
  std::filesystem::path Output(const std::string& name) const { return files_ / ("out." + name); }

 private:
  std::string_view bytes_;
  TemporaryFolder files_;
};

// One way of reading hostile input. Each is a global constant, which registers it under its name.
class FuzzTarget {
 public:
  // Whatever `read` throws is a finding.
  using Read = std::function<void(const HostileInput& input)>;

  FuzzTarget(const std::string& name, const Read& read);
  // All targets by name.
  static std::map<std::string, Read>& All();
};

// Throws std::logic_error unless an error that a user gets to see names this file or folder.
void CheckNames(const Error& error, const std::filesystem::path& path);

// Whether `read` accepts the input at `path`. It may refuse it with an error of ours that names the
// path.
template <typename ReadFile>
bool IsAccepted(const std::filesystem::path& path, const ReadFile& read) {
  try {
    read();
    return true;
  } catch (const Error& error) {
    CheckNames(error, path);
    return false;
  }
}

// Reads the input at `path` in each of these ways, each of which may refuse it so.
template <typename... Readers>
void ReadBy(const std::filesystem::path& path, const Readers&... readers) {
  (IsAccepted(path, [&] { readers(path); }), ...);
}

}  // namespace soslam

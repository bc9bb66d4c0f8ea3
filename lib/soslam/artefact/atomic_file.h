// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string_view>

namespace soslam {

// A file that is written completely or not at all: write to TemporaryPath(), then Commit(). Until
// then, and on failure, an existing file of that name is unchanged.
class AtomicFile {
 public:
  // Creates the empty temporary in the folder of `path`, which must exist. Throws SettingsError
  // when that folder cannot be written to, or `path` is a folder itself.
  explicit AtomicFile(std::filesystem::path path);
  // Removes the temporary if it was not committed.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::filesystem::path& TemporaryPath() const { return temporary_; }

  // Moves the temporary to its final name once it is safe on disk. An existing file with the same
  // bytes is kept instead, with its modification time, so that Make reruns nothing that depends on
  // it. Throws SettingsError when the disk refuses, InputError as CheckInputsUnchanged.
  void Commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
};

// Forces a file or folder to disk with fsync or syncfs; returns the errno of a failure, else 0.
int SyncWith(int (*sync)(int), const std::filesystem::path& path);

// Writes a whole file atomically. Errors as AtomicFile; also when the disk is full.
void WriteTextFile(const std::filesystem::path& path, std::string_view text);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace soslam {

// A dataset folder that a program writes, and that appears completely or not at all: fill it with
// Write, then Commit(). SHA256SUMS in it lists its files, so that those that others have added or
// changed since are never replaced.
class DatasetFolder {
 public:
  // Creates the temporary folder beside `folder`. `writer` is the name of the program. Throws
  // SettingsError when `folder` is not a folder, contains anything but an earlier dataset of this
  // writer, unchanged, and records of runs, or cannot be written.
  DatasetFolder(const std::filesystem::path& folder, std::string writer);
  // Removes the temporary folder, or the one that it replaced.
  ~DatasetFolder();
  DatasetFolder(const DatasetFolder&) = delete;
  DatasetFolder& operator=(const DatasetFolder&) = delete;

  const std::filesystem::path& Temporary() const { return temporary_; }

  // Begin of the first line of README.md, by which a later run recognises a folder of its own.
  std::string Mark() const;

  // Writes a file of the folder. Throws SettingsError when the disk refuses.
  void Write(const std::string& name, std::string_view bytes) const;

  // Moves the temporary folder to the place of `folder`. Throws SettingsError when the disk
  // refuses, InputError as CheckInputsUnchanged.
  void Commit();

 private:
  void CheckReplaceable() const;

  std::filesystem::path folder_;
  std::string writer_;
  std::filesystem::path temporary_;
};

}  // namespace soslam

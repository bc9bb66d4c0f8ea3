// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace soslam {

struct FileDigest {
  std::filesystem::path path;  // as it was given
  std::string sha256;
};

// While this lives, the files that this program reads and writes are noted, each once; otherwise
// the functions below note nothing. There is one at a time.
class RunLog {
 public:
  RunLog();
  ~RunLog();
  RunLog(const RunLog&) = delete;
  RunLog& operator=(const RunLog&) = delete;

  // By absolute path.
  std::vector<FileDigest> Inputs() const;
  std::vector<FileDigest> Outputs() const;
  std::optional<int> Seed() const;
};

// For every reader of files, before it opens one: notes what the file holds. A file that cannot be
// read is not noted, as its reader will say more. May be called by several threads at once.
void NoteInput(const std::filesystem::path& path);

// SHA-256 of an input: of what it held when it was noted, else of what it holds. Throws InputError
// when it cannot be read.
std::string DigestOfInput(const std::filesystem::path& path);

// For every writer, before an output gets its name: a result must not be of files that are no
// longer what they were when they were read. Files that the run replaces itself do not count.
// Throws InputError, naming the file.
void CheckInputsUnchanged();

// For every writer, after an output got its name. Throws InputError when it cannot be read back.
void NoteOutput(const std::filesystem::path& path);

// For what draws random numbers.
void NoteSeed(int seed);

}  // namespace soslam

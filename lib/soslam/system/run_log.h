// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace soslam {

struct FileDigest {
  std::filesystem::path path;  // as the caller gave it
  std::string sha256;
};

// While this lives, the files that this program reads and writes are recorded, each once; otherwise
// the functions below do nothing. Only one may exist at a time.
class RunLog {
 public:
  RunLog();
  ~RunLog();
  RunLog(const RunLog&) = delete;
  RunLog& operator=(const RunLog&) = delete;

  // Sorted by absolute path.
  std::vector<FileDigest> Inputs() const;
  std::vector<FileDigest> Outputs() const;
  std::optional<int> Seed() const;
};

// Records the content of an input file. Every reader of files calls it before it opens one. A file
// that cannot be read is not recorded; its reader reports the error in more detail. Thread-safe.
void RecordInput(const std::filesystem::path& path);

// SHA-256 of an input file: as recorded, or of its current content if it was not recorded. Throws
// InputError when it cannot be read.
std::string DigestOfInput(const std::filesystem::path& path);

// Throws InputError, naming the file, if an input has changed since it was read: a result must not
// depend on content that no longer exists. Every writer calls it before an output gets its name.
// Files that the run replaces itself are exempt.
void CheckInputsUnchanged();

// Records an output file. Every writer calls it after the output got its name. Throws InputError
// when the file cannot be read back.
void RecordOutput(const std::filesystem::path& path);

// Records the seed of random numbers.
void NoteSeed(int seed);

}  // namespace soslam

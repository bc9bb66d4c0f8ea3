// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/system/run_log.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <map>
#include <mutex>

#include "soslam/base/error.h"
#include "soslam/system/hash.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

// Detects that a file may have changed, without reading it. Only the system sets changed_ns, the
// time of the last change of content or attributes.
struct Stamp {
  dev_t device;
  ino_t inode;
  off_t size;
  std::int64_t modified_ns, changed_ns;

  bool operator==(const Stamp&) const = default;
};

std::int64_t Nanoseconds(const timespec& time) {
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

// The stamp of a regular file; none if there is no such file.
std::optional<Stamp> ReadStamp(const fs::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  return Stamp{status.st_dev, status.st_ino, status.st_size, Nanoseconds(status.st_mtim),
               Nanoseconds(status.st_ctim)};
}

struct NotedInput {
  FileDigest digest;
  Stamp stamp;  // taken before the digest
};

// Recorded files (keyed by absolute path) and seed of this program.
struct Notes {
  std::mutex mutex;
  std::map<fs::path, NotedInput> inputs;
  std::map<fs::path, FileDigest> outputs;
  std::optional<int> seed;
};

std::optional<Notes>& NotesOfProgram() {
  static std::optional<Notes> notes;
  return notes;
}

fs::path Key(const fs::path& path) { return fs::absolute(path).lexically_normal(); }

// Stamp and digest of a file; none when it cannot be read.
std::optional<NotedInput> Digest(const fs::path& path) {
  const std::optional<Stamp> stamp = ReadStamp(path);
  if (!stamp) return std::nullopt;
  try {
    return NotedInput{{path, Sha256OfFile(path)}, *stamp};
  } catch (const InputError&) {
    return std::nullopt;
  }
}

}  // namespace

RunLog::RunLog() { NotesOfProgram().emplace(); }

RunLog::~RunLog() { NotesOfProgram().reset(); }

std::vector<FileDigest> RunLog::Inputs() const {
  std::vector<FileDigest> inputs;
  for (const auto& [key, input] : NotesOfProgram()->inputs) inputs.push_back(input.digest);
  return inputs;
}

std::vector<FileDigest> RunLog::Outputs() const {
  std::vector<FileDigest> outputs;
  for (const auto& [key, output] : NotesOfProgram()->outputs) outputs.push_back(output);
  return outputs;
}

std::optional<int> RunLog::Seed() const { return NotesOfProgram()->seed; }

void RecordInput(const fs::path& path) {
  std::optional<Notes>& notes = NotesOfProgram();
  if (!notes) return;
  const fs::path key = Key(path);
  {
    const std::scoped_lock lock(notes->mutex);
    if (notes->inputs.contains(key)) return;
  }
  const std::optional<NotedInput> input = Digest(path);
  const std::scoped_lock lock(notes->mutex);
  if (input) notes->inputs.emplace(key, *input);
}

std::string DigestOfInput(const fs::path& path) {
  RecordInput(path);
  if (std::optional<Notes>& notes = NotesOfProgram()) {
    const std::scoped_lock lock(notes->mutex);
    const auto input = notes->inputs.find(Key(path));
    if (input != notes->inputs.end()) return input->second.digest.sha256;
  }
  return Sha256OfFile(path);
}

void CheckInputsUnchanged() {
  std::optional<Notes>& notes = NotesOfProgram();
  if (!notes) return;
  const std::scoped_lock lock(notes->mutex);
  for (const auto& [key, input] : notes->inputs) {
    const bool is_unchanged = ReadStamp(key) == input.stamp || notes->outputs.contains(key);
    if (is_unchanged) continue;
    const std::optional<NotedInput> now = Digest(key);
    if (!now || now->digest.sha256 != input.digest.sha256) {
      throw InputError(fmt::format(
          "{}: was {} while this run used it; expected a file that stays as it is until the end",
          input.digest.path.string(), now ? "changed" : "removed"));
    }
  }
}

void RecordOutput(const fs::path& path) {
  std::optional<Notes>& notes = NotesOfProgram();
  if (!notes) return;
  const FileDigest output = {path, Sha256OfFile(path)};
  const std::scoped_lock lock(notes->mutex);
  notes->outputs[Key(path)] = output;
}

void NoteSeed(int seed) {
  if (NotesOfProgram()) NotesOfProgram()->seed = seed;
}

}  // namespace soslam

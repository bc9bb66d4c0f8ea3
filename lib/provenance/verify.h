// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "provenance/recorded_runs.h"

namespace soslam {

// Compares files with what they held once; each is read once only.
class FileDigests {
 public:
  // "is gone", "has changed", "cannot be read"; none when it holds what it held.
  std::optional<std::string> ChangeOf(const std::filesystem::path& path, const std::string& sha256);
  size_t files() const { return digests_.size(); }

 private:
  std::map<std::filesystem::path, std::string> digests_;  // empty: cannot be read
};

// Something that does not match its record.
struct Discrepancy {
  std::string text;                   // one line: which file, what of it
  std::vector<std::string> variants;  // whose results it concerns
};

struct Verification {
  std::vector<Discrepancy> discrepancies;
  size_t files = 0;  // that were compared
};

// Compares the files of all runs of a dataset with their run.json: inputs, outputs, and the links
// of variants to them.
Verification Verify(const DatasetRuns& dataset);

}  // namespace soslam

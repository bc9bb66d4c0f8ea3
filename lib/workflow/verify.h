// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "workflow/recorded_runs.h"

namespace soslam {

// Compares files with their recorded digests; each file is read only once.
class FileDigests {
 public:
  // "is gone", "has changed", "cannot be read"; none when the content is unchanged.
  std::optional<std::string> ChangeOf(const std::filesystem::path& path, const std::string& sha256);
  size_t files() const { return digests_.size(); }

 private:
  std::map<std::filesystem::path, std::string> digests_;  // empty: cannot be read
};

// Something that does not match its record.
struct Discrepancy {
  std::string text;                   // one line: the file and its problem
  std::vector<std::string> variants;  // variants whose results it concerns
};

struct Verification {
  std::vector<Discrepancy> discrepancies;
  size_t files = 0;  // number of compared files
};

// Compares the files of all runs of a dataset with their run.json: inputs, outputs, and the links
// of variants to them.
Verification Verify(const DatasetRuns& dataset);

}  // namespace soslam

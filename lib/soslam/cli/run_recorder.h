// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "soslam/artefact/run_file.h"
#include "soslam/base/error.h"
#include "soslam/cli/command_line.h"
#include "soslam/system/run_log.h"

namespace soslam::internal {

// Writes the record of a run beside its first output: run.json in any case, timing.json after
// success. Nothing for programs that are not recorded.
class RunRecorder {
 public:
  // Starts the record; the files given to the stage count as read. `settings_file`: empty for none.
  // Throws SettingsError for a file of others with the name of one of the record's.
  RunRecorder(const StageInfo& info, const StageFiles& files,
              const std::filesystem::path& settings_file, int threads);

  // `resolved`: the value of every option after merging these layers.
  void SetSettings(const nlohmann::json& resolved, const std::vector<SettingsLayer>& layers);

  // Throws SettingsError when the files cannot be written.
  void RecordSuccess();
  // Ignores a failure to write the record: the error is on stderr as well.
  void RecordFailure(const Error& error);

 private:
  // Completes the record and ends the log.
  void Finish();
  RunFile Place(const FileDigest& file) const;

  std::optional<std::filesystem::path> folder_;  // none: not recorded
  StageFiles files_;                             // includes the settings file
  RunRecord record_;                             // as far as known
  std::optional<RunLog> log_;
  int threads_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace soslam::internal

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace soslam {

// Software that results may depend on besides inputs and settings.
struct Software {
  std::string version;                           // "soslam 0.1.0"
  std::string compiler;                          // "GCC 12.2.0"
  std::map<std::string, std::string> libraries;  // name -> version: "opencv" -> "4.6.0"

  bool operator==(const Software&) const = default;
};

// The software of this program. The version of a library is that of the running one where it can be
// queried, otherwise (Ceres, CLI11, Eigen, fmt, nlohmann-json) that of the headers.
Software ThisSoftware();

// Base folders of RunFile paths, in addition to the folders given as arguments.
inline constexpr const char* kRelativeToRun = "run";    // the folder of run.json
inline constexpr const char* kRelativeToCall = "call";  // RunRecord::called_in

// A file that a run read or wrote. The path is relative to the run for files of a results folder,
// and to the argument for files in a folder given as argument, so that both can be moved.
struct RunFile {
  std::optional<std::string> argument;  // the one that names the file or its folder, if any
  std::string relative_to;              // kRelativeToRun, kRelativeToCall or an argument
  std::filesystem::path path;
  std::string sha256;
};

struct RunSetting {
  nlohmann::json value;
  std::string origin;  // "default", "settings file" or "command line"
};

// One run of a stage: the content of run.json (schemas/run.schema.json).
struct RunRecord {
  std::string stage;  // the executable: "soslam-refine"
  Software software;
  std::optional<std::map<std::string, RunSetting>> settings;  // none: they were not valid
  bool allow_outside_paths = false;
  std::optional<int> seed;
  std::filesystem::path called_in;                       // absolute
  std::map<std::string, std::filesystem::path> folders;  // arguments that are folders, as called
  std::vector<RunFile> inputs;
  std::vector<RunFile> outputs;
  int exit_code = 0;
  std::string error;      // empty after success
  nlohmann::json timing;  // schemas/timing.schema.json without the stage
};

// Throws SettingsError when the file cannot be written.
void WriteRun(const std::filesystem::path& path, const RunRecord& record);

// Throws InputError, naming file and field, when it is missing or not valid.
RunRecord ReadRun(const std::filesystem::path& path);

}  // namespace soslam

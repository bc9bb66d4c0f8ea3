// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <vector>

#include "soslam/artefact/options_json.h"
#include "soslam/base/error.h"
#include "soslam/base/options.h"
#include "soslam/model/finding.h"

namespace CLI {
class App;
}

namespace soslam {

// The options of a stage that has none.
struct NoOptions {
  void Describe(OptionVisitor& /*visit*/) {}
};

// The files that a stage was called with, keyed by argument name; absent when an optional one was
// not given. The second and later files of a repeatable argument are named by RepeatedName.
using StageFiles = std::map<std::string, std::filesystem::path>;

// Name of the file that a repeatable argument gives at `index` (from 0): "sequence", "sequence#1"
// and so on.
inline std::string RepeatedName(const std::string& argument, size_t index) {
  return index == 0 ? argument : argument + "#" + std::to_string(index);
}

// All files of a repeatable argument, in the order given.
inline std::vector<std::filesystem::path> FilesOf(const StageFiles& files,
                                                  const std::string& argument) {
  std::vector<std::filesystem::path> paths;
  for (auto file = files.find(argument); file != files.end();
       file = files.find(RepeatedName(argument, paths.size()))) {
    paths.push_back(file->second);
  }
  return paths;
}

// The warning that a setting has no effect: `file` names where it is set; one of the conditions
// `unmet`, at least one, would have to hold.
Finding SettingWithoutEffect(const std::string& file, const std::string& name,
                             const nlohmann::json& value, const OptionVisitor::Conditions& unmet);

// Prints findings on stderr, one per line.
void ReportFindings(const std::string& stage, const std::vector<Finding>& findings);

// Reads a settings file written by a user, a JSON object. Throws SettingsError, naming the file,
// when it cannot be read, is malformed or is not an object.
nlohmann::json ReadSettingsFile(const std::filesystem::path& path);

// A file or folder argument of a stage: --<name> PATH.
struct FileArgument {
  std::string name;
  std::string doc;
  bool required = true;
  bool repeatable = false;  // may be given several times, or with several paths
  bool is_folder = false;   // for outputs only
};

// Help text of a stage.
struct StageInfo {
  std::string name;     // name of the executable: "soslam-edges"
  std::string purpose;  // one sentence
  std::vector<FileArgument> inputs;
  std::vector<FileArgument> outputs;
  std::string example;  // one command
  // Meaning of the exit code kFindings; empty for stages that do not return it.
  std::string findings = "";
  // True if it writes run.json and timing.json beside its first output.
  bool is_recorded = true;
};

// Exit code of a program that searches for something and found it, as in diff.
inline constexpr int kFindings = 1;

namespace internal {

// Settings from one source, named for error messages.
struct SettingsLayer {
  std::string where;
  std::string origin;  // for the record of the run; values from no layer have "default"
  nlohmann::json values;
};

// Functions of a stage that depend on the type of its options.
struct StageBody {
  // Applies the settings, later layers win; returns the value of every option.
  std::function<nlohmann::json(const std::vector<SettingsLayer>&)> resolve;
  // Runs the stage and returns the exit code; threads >= 1.
  std::function<int(const StageFiles& files, int threads)> run;
};

// Help text on exit codes; `findings`: see StageInfo.
std::string ExitCodesHelp(const std::string& findings);

// Adds options --help and --version to a program.
void AddHelpAndVersion(CLI::App* app);

// Adds option --allow_outside_paths to a program that reads images of datasets.
void AddOutsidePaths(CLI::App* app);

// Calls `run`, which parses the command line first, and returns its exit code. Errors that it
// throws become one line on stderr and their exit codes; --help and --version are answered.
int RunForExitCode(CLI::App* app, const std::function<int()>& run);

int RunStageMain(int argc, const char* const* argv, const StageInfo& info,
                 const std::vector<OptionRow>& options, const StageBody& body);

}  // namespace internal

// The main function of a stage: parses the command line, calls `run` and returns the exit code,
// which is that of `run` if it returns int. Options: defaults < --settings FILE < --<option> VALUE.
// An error is one line on stderr. The record of the run is run.json beside its first output, also
// after failure; after success timing.json is there, too.
template <typename Options, typename Result>
int StageMain(int argc, const char* const* argv, const StageInfo& info,
              Result (*run)(const Options& options, const StageFiles& files, int threads)) {
  Options options;
  const auto resolve = [&options](const std::vector<internal::SettingsLayer>& layers) {
    for (const internal::SettingsLayer& layer : layers) {
      OptionsFromJson(layer.values, layer.where, &options);
    }
    return OptionsToJson(options);
  };
  const auto run_resolved = [&options, run](const StageFiles& files, int threads) -> int {
    if constexpr (std::is_void_v<Result>) {
      run(options, files, threads);
      return static_cast<int>(ExitCode::kDone);
    } else {
      return run(options, files, threads);
    }
  };
  return internal::RunStageMain(argc, argv, info, OptionRows<Options>(), {resolve, run_resolved});
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <vector>

#include "base/error.h"
#include "base/options.h"
#include "stage/stage_files.h"

namespace CLI {
class App;
}

namespace soslam {

// A file or folder that a stage is called with: --<name> PATH.
struct FileArgument {
  std::string name;
  std::string doc;
  bool required = true;
  bool repeatable = false;  // may be given several times, or with several paths
  bool is_folder = false;   // of outputs
};

// What --help says about a stage.
struct StageInfo {
  std::string name;     // of the executable: "soslam-edges"
  std::string purpose;  // one sentence
  std::vector<FileArgument> inputs;
  std::vector<FileArgument> outputs;
  std::string example;  // one command
  // What the exit code kFindings means; empty for stages that have none.
  std::string findings = "";
  // Whether it leaves run.json and timing.json beside its first output.
  bool is_recorded = true;
};

// Exit code of what was asked to look for something, and found it, as diff has it.
inline constexpr int kFindings = 1;

namespace internal {

// Settings from one source, named for error messages.
struct SettingsLayer {
  std::string where;
  std::string origin;  // for the record of the run, where "default" is that of all other values
  nlohmann::json values;
};

// What a stage does with its options, whose type only it knows.
struct StageBody {
  // Takes the settings, later ones win; the value of every option.
  std::function<nlohmann::json(const std::vector<SettingsLayer>&)> resolve;
  // The exit code; threads >= 1.
  std::function<int(const StageFiles& files, int threads)> run;
};

// What --help says of exit codes; `findings`: as StageInfo has it.
std::string ExitCodesHelp(const std::string& findings);

// Options --help and --version of a program.
void AddHelpAndVersion(CLI::App* app);

// Option --allow_outside_paths of a program that reads images of datasets.
void AddOutsidePaths(CLI::App* app);

// What `run`, which parses the command line first, returns: an exit code. Errors that it throws
// become one line on stderr and their exit codes; --help and --version are answered.
int ExitCodeOf(CLI::App* app, const std::function<int()>& run);

int RunStageMain(int argc, const char* const* argv, const StageInfo& info,
                 const std::vector<OptionRow>& options, const StageBody& body);

}  // namespace internal

// The main of a stage: reads the command line, calls `run` and returns the exit code, which is
// that of `run` where it has one (int). Options: defaults < --settings FILE < --<option> VALUE. An
// error is one line on stderr. What the run was is in run.json beside its first output, also when
// it fails; after success timing.json lies there, too.
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

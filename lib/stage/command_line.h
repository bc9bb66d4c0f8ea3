// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

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
};

// What --help says about a stage.
struct StageInfo {
  std::string name;     // of the executable: "soslam-edges"
  std::string purpose;  // one sentence
  std::vector<FileArgument> inputs;
  std::vector<FileArgument> outputs;
  std::string example;  // one command
};

namespace internal {

// Settings from one source, named for error messages.
struct SettingsLayer {
  std::string where;
  nlohmann::json values;
};

struct StageCall {
  std::vector<SettingsLayer> settings;  // later ones win
  StageFiles files;
  int threads = 1;  // >= 1
};

// What every --help says of exit codes.
extern const char* const kExitCodes;

// Options --help and --version of a program.
void AddHelpAndVersion(CLI::App* app);

// Option --allow_outside_paths of a program that reads images of datasets.
void AddOutsidePaths(CLI::App* app);

// What `run`, which parses the command line first, returns: an exit code. Errors that it throws
// become one line on stderr and their exit codes; --help and --version are answered.
int ExitCodeOf(CLI::App* app, const std::function<int()>& run);

int RunStageMain(int argc, const char* const* argv, const StageInfo& info,
                 const std::vector<OptionRow>& options,
                 const std::function<void(const StageCall&)>& run);

}  // namespace internal

// The main of a stage: reads the command line, calls `run` and returns the exit code. Options:
// defaults < --settings FILE < --<option> VALUE. An error is one line on stderr. After success,
// timing.json lies beside the file (or in the folder) given as "output".
template <typename Options>
int StageMain(int argc, const char* const* argv, const StageInfo& info,
              void (*run)(const Options& options, const StageFiles& files, int threads)) {
  return internal::RunStageMain(argc, argv, info, OptionRows<Options>(),
                                [run](const internal::StageCall& call) {
                                  Options options;
                                  for (const internal::SettingsLayer& layer : call.settings) {
                                    OptionsFromJson(layer.values, layer.where, &options);
                                  }
                                  run(options, call.files, call.threads);
                                });
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <sys/wait.h>

#include <csignal>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "soslam/artefact/atomic_file.h"
#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/dataset/image_path.h"
#include "soslam/inspection/difference.h"
#include "soslam/report/results_tree.h"
#include "soslam/system/hash.h"
#include "soslam/workflow/pipeline_stages.h"
#include "soslam/workflow/verify.h"

namespace soslam {
namespace {

// The word quoted for a shell.
std::string Quoted(const std::string& word) {
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

namespace fs = std::filesystem;

std::set<std::string> CompareSoftware(const Software& then, const Software& now) {
  std::set<std::string> changes;
  const auto compare = [&](const std::string& what, const std::string& a, const std::string& b) {
    if (a == b) return;
    changes.insert(
        fmt::format("{} {} is {} now", what, a.empty() ? "(none)" : a, b.empty() ? "not used" : b));
  };
  compare("software", then.version, now.version);
  compare("compiler", then.compiler, now.compiler);
  std::map<std::string, std::string> names = then.libraries;
  names.insert(now.libraries.begin(), now.libraries.end());
  const auto version = [](const Software& software, const std::string& name) {
    const auto found = software.libraries.find(name);
    return found == software.libraries.end() ? std::string() : found->second;
  };
  for (const auto& [name, ignored] : names) compare(name, version(then, name), version(now, name));
  return changes;
}

// First difference between two artefacts of different bytes. Those of headers come last: a header
// has the hashes of the inputs, and differs whenever they do.
std::string FirstDifference(const fs::path& recorded, const fs::path& again) {
  constexpr double kExactly = 0.0;
  try {
    const Differences differences = CompareArtefacts(recorded, again, kExactly);
    for (const std::vector<Difference>* places : {&differences.content, &differences.provenance}) {
      if (places->empty()) continue;
      const Difference& first = places->front();
      return fmt::format("{}: {} is {} now", first.place, first.one, first.two);
    }
  } catch (const InputError& error) {
    return error.what();
  }
  return "only in how the same values are stored";
}

// Repeats the runs of a dataset one by one.
class Reproduction {
 public:
  Reproduction(const DatasetRuns& dataset, const fs::path& executables, const fs::path& again,
               int threads)
      : dataset_(dataset), executables_(executables), again_(again), threads_(threads) {}

  // Repeats one run; calls `use` with its outcomes.
  void Rerun(const RecordedRun& run, const std::function<void(const Outcome&)>& use) {
    const auto not_rerun = [&](const std::string& why) {
      use({Outcome::Kind::kNotRerun, run.folder, why});
    };
    RunRecord record;
    try {
      record = ReadRun(run.folder / "run.json");
    } catch (const InputError& error) {
      return not_rerun(error.what());
    }
    software_changes_.merge(CompareSoftware(record.software, ThisSoftware()));
    if (const auto obstacle = Obstacle(record, run)) return not_rerun(*obstacle);
    if (const auto failure = RunAgain(record, run)) return not_rerun(*failure);
    rerun_.insert(run.folder);
    for (const RunFile& output : record.outputs) {
      use(Compare(LocateFile(output, record, run, dataset_)));
    }
  }

  const std::set<std::string>& software_changes() const { return software_changes_; }

 private:
  // Reason why a rerun is pointless, such as an input that has changed and was not made again; none
  // if there is none.
  std::optional<std::string> Obstacle(const RunRecord& record, const RecordedRun& run) {
    if (record.exit_code != 0) return "it failed when it was recorded: " + record.error;
    if (record.outputs.empty() || !record.settings)
      return "its record has no outputs or no settings";
    if (record.allow_outside_paths && !OutsidePathsAreAllowed()) {
      return "it was called with --allow_outside_paths, which has to be given again";
    }
    if (auto foreign = ForeignWrite(record, run)) return foreign;
    for (const RunFile& input : record.inputs) {
      const fs::path path = LocateFile(input, record, run, dataset_);
      if (path.parent_path() == run.folder) continue;  // its settings, which are recorded
      if (IsResult(path)) {
        if (!rerun_.contains(path.parent_path())) {
          return fmt::format("{}, which it reads, was not made again", path.string());
        }
      } else if (const auto change = digests_.DescribeChange(path, input.sha256)) {
        return fmt::format("{} {} since", path.string(), *change);
      }
    }
    return std::nullopt;
  }

  // Checks for writes outside of the results, as a record may come from anybody; returns the reason
  // to refuse it, or none.
  std::optional<std::string> ForeignWrite(const RunRecord& record, const RecordedRun& run) const {
    constexpr std::string_view kPrefix = "soslam-";
    std::set<std::string> written;
    for (const StageOutput& output : OutputsOfStage(record.stage.substr(kPrefix.size()))) {
      written.insert(output.argument);
    }
    if (written.empty()) return record.stage + " is no stage of the pipeline";
    for (const RunFile& input : record.inputs) {
      if (input.argument && written.contains(*input.argument))
        return "--" + *input.argument + " is among its inputs";
    }
    for (const auto& [argument, folder] : record.folders) {
      if (written.contains(argument)) return "--" + argument + " is a folder";
    }
    for (const RunFile& output : record.outputs) {
      const fs::path path = LocateFile(output, record, run, dataset_);
      if (IsResult(path)) continue;
      return fmt::format("it wrote {}, which is outside of {}", path.string(),
                         dataset_.results.string());
    }
    return std::nullopt;
  }

  // Repeats a run; returns the reason of a failure, none after success.
  std::optional<std::string> RunAgain(const RunRecord& record, const RecordedRun& run) const {
    const fs::path folder = Again(run.folder);
    fs::create_directories(folder);
    nlohmann::json settings = nlohmann::json::object();
    for (const auto& [name, setting] : record.settings.value()) settings[name] = setting.value;
    WriteTextFile(folder / "settings.json", settings.dump(2) + "\n");
    std::vector<std::string> words = {(executables_ / record.stage).string(),
                                      "--quiet",
                                      "--threads",
                                      std::to_string(threads_),
                                      "--settings",
                                      (folder / "settings.json").string(),
                                      "--failure_record",
                                      (folder / "failed").string()};
    if (record.allow_outside_paths) words.emplace_back("--allow_outside_paths");
    const auto add = [&words](const std::string& argument, const fs::path& path) {
      words.insert(words.end(), {"--" + argument, path.string()});
    };
    for (const auto& [argument, path] : record.folders) {
      add(argument, LocateFolder(argument, record, dataset_));
    }
    for (const std::vector<RunFile>* files : {&record.inputs, &record.outputs}) {
      for (const RunFile& file : *files) {
        const bool is_in_a_folder = file.argument == file.relative_to;
        if (is_in_a_folder || file.argument.value_or("").empty() || file.argument == "settings")
          continue;
        const fs::path path = LocateFile(file, record, run, dataset_);
        add(*file.argument, IsResult(path) ? Again(path) : path);
      }
    }
    const int exit_code = RunProgram(words, folder / "printed.txt");
    if (exit_code == 0) return std::nullopt;
    if (exit_code == 128 + SIGINT) throw NothingUsableError("interrupted");
    const std::string failure = FailureIn(folder);
    return "it failed: " + (failure.empty() ? fmt::format("exit code {}", exit_code) : failure);
  }

  Outcome Compare(const fs::path& artefact) const {
    const fs::path again = Again(artefact);
    if (!Exists(artefact)) return {Outcome::Kind::kDiffers, artefact, "is gone"};
    if (!Exists(again)) return {Outcome::Kind::kDiffers, artefact, "was not written again"};
    try {
      if (Sha256OfFile(artefact) == Sha256OfFile(again))
        return {Outcome::Kind::kSame, artefact, ""};
    } catch (const InputError& error) {
      return {Outcome::Kind::kDiffers, artefact, error.what()};
    }
    return {Outcome::Kind::kDiffers, artefact, FirstDifference(artefact, again)};
  }

  // True if a file is in the results of the dataset.
  bool IsResult(const fs::path& path) const { return IsWithin(path, dataset_.results); }

  fs::path Again(const fs::path& path) const {
    return again_ / path.lexically_relative(dataset_.results);
  }

  const DatasetRuns& dataset_;
  const fs::path& executables_;
  const fs::path& again_;
  int threads_;
  FileDigests digests_;
  std::set<fs::path> rerun_;  // folders of the repeated runs
  std::set<std::string> software_changes_;
};

}  // namespace

int RunProgram(const std::vector<std::string>& words, const std::filesystem::path& printed) {
  std::string command = "exec";  // so that the status is the program's, not the shell's
  for (const std::string& word : words) command += " " + Quoted(word);
  const int status = std::system((command + " > " + Quoted(printed.string()) + " 2>&1").c_str());
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

std::set<std::string> Reproduce(const DatasetRuns& dataset, const fs::path& executables,
                                const fs::path& again, int threads,
                                const std::function<void(const Outcome&)>& use) {
  Reproduction reproduction(dataset, executables, again, threads);
  for (const RecordedRun& run : dataset.runs) reproduction.Rerun(run, use);
  return reproduction.software_changes();
}

}  // namespace soslam

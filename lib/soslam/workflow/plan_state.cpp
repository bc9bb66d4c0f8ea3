// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/workflow/plan_state.h"

#include <fmt/format.h>

#include <fstream>
#include <optional>
#include <sstream>

#include "soslam/artefact/json_file.h"
#include "soslam/artefact/options_json.h"
#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/base/text.h"
#include "soslam/report/results_tree.h"
#include "soslam/workflow/pipeline_stages.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::optional<fs::file_time_type> ReadModificationTime(const fs::path& file) {
  std::error_code error;
  const auto time = fs::last_write_time(file, error);
  return error ? std::nullopt : std::optional(time);
}

std::vector<std::string> ReadLines(const fs::path& file) {
  std::ifstream stream(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

// Files of a listing newer than `done`. A listing has the dataset's folder in its first line, then
// lines "<name> <size> <time>" of the files whose content is read, and names of files whose
// existence alone matters.
std::string NewerFilesListedIn(const fs::path& listing, const fs::path& dataset,
                               fs::file_time_type done) {
  std::vector<std::string> newer;
  for (const std::string& line : ReadLines(listing)) {
    const size_t end = line.rfind(' ', line.rfind(' ') - 1);
    if (end == std::string::npos) continue;
    const std::string name = line.substr(0, end);
    const auto time = ReadModificationTime(dataset / name);
    if (time && *time > done) newer.push_back(name);
  }
  if (newer.empty()) return "files of the dataset came, went or were replaced since";
  return "files of the dataset have changed since: " + NamesInWords(newer, 5);
}

}  // namespace

std::map<std::string, StagesUnderWay> ReadStagesUnderWay(const fs::path& file) {
  std::map<std::string, StagesUnderWay> under_way;
  for (const std::string& line : ReadLines(file)) {
    std::istringstream words(line);
    std::string dataset, id, state, more;
    words >> dataset >> id >> state;
    const bool is_running = state == NameOf(StageState::kRunning);
    if ((!is_running && state != NameOf(StageState::kQueued)) || words >> more) {
      throw InputError(fmt::format(
          "{}: a line is '{}'; expected '<dataset> <stage run> queued' or '... running'",
          file.string(), line));
    }
    const auto known = under_way[dataset].try_emplace(id, StageState::kQueued).first;
    if (is_running) known->second = StageState::kRunning;
  }
  return under_way;
}

std::map<std::string, InstanceState> DetermineStates(const Plan& plan, const PlanFolders& folders,
                                                     const StagesUnderWay& under_way) {
  std::map<std::string, InstanceState> states;
  for (const StageInstance& instance : plan.instances) {
    const auto result = [&](const std::string& file) {
      return folders.results / InstancePath(instance.Id(), file);
    };
    const auto done = ReadModificationTime(result("done"));
    const std::string failure = FailureIn(result(""));
    InstanceState found;
    if (!failure.empty()) {
      found.state = StageState::kFailed;
      found.reasons.push_back("its last run failed: " + failure);
    } else if (!done) {
      found.state = StageState::kMissing;
      found.reasons.emplace_back("it has not run with these settings and inputs");
    }
    if (done) {
      for (const StageOutput& output : OutputsOfStage(instance.stage)) {
        if (Exists(result(output.file))) continue;
        found.reasons.push_back(output.file + ", which it writes, is gone");
      }
      for (const fs::path& path : ListPrerequisites(instance, folders)) {
        const auto time = ReadModificationTime(path);
        if (!time) found.reasons.push_back(path.string() + " does not exist");
        if (!time || *time <= *done) continue;
        const bool is_listing =
            path == folders.results / kDatasetListing || path == folders.results / kImagesListing;
        found.reasons.push_back(is_listing ? NewerFilesListedIn(path, folders.dataset, *done)
                                           : path.string() + " has changed since");
      }
    }
    for (const auto& [argument, source] : instance.inputs) {
      const StageState state = states.at(source.instance).state;
      if (state == StageState::kDone) continue;
      found.reasons.push_back(fmt::format("{} comes from {}, which is {}", source.file,
                                          source.instance, NameOf(state)));
    }
    if (found.state == StageState::kDone && !found.reasons.empty()) {
      found.state = StageState::kStale;
    }
    const auto job = under_way.find(instance.Id());
    if (found.state != StageState::kDone && job != under_way.end()) found.state = job->second;
    states[instance.Id()] = std::move(found);
  }
  return states;
}

std::vector<std::string> ChangesSinceLastRun(const Plan& plan, const VariantChain& variant,
                                             const StageInstance& instance,
                                             const PlanFolders& folders) {
  std::map<std::string, std::string> last;  // stage -> id
  for (const std::string& id : ReadLines(folders.results / variant.name / ".linked")) {
    last[StageOf(id)] = id;
  }
  const auto before = last.find(instance.stage);
  if (before == last.end() || before->second == instance.Id()) return {};
  const fs::path settings = folders.results / InstancePath(before->second, "settings.json");
  std::vector<std::string> changes;
  if (Exists(settings)) changes = SettingChanges(ParseJsonFile(settings), instance.settings);
  for (const auto& [argument, source] : instance.inputs) {
    const std::string stage = plan.Instance(source.instance).stage;
    const auto earlier = last.find(stage);
    const std::string old_id = earlier == last.end() ? "none" : earlier->second;
    if (old_id != source.instance) {
      changes.push_back(fmt::format("{}: {} -> {}", source.file, old_id, source.instance));
    }
  }
  if (changes.empty()) changes.emplace_back("it reads another semantic table, or of other stages");
  return changes;
}

}  // namespace soslam

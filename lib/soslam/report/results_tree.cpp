// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/report/results_tree.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>

#include "soslam/artefact/files.h"
#include "soslam/artefact/json_file.h"
#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/base/table.h"
#include "soslam/base/text.h"
#include "soslam/model/describe_metrics.h"
#include "soslam/system/run_log.h"

namespace soslam {

namespace fs = std::filesystem;

std::vector<std::string> RunsIn(const fs::path& list) {
  constexpr size_t kMaxName = 255;  // bytes; limit of names on Linux
  RecordInput(list);
  std::vector<std::string> runs;
  std::ifstream lines(list);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty()) continue;
    if (line.size() > kMaxName || fs::path(line).filename() != line || line == "..") {
      throw InputError(
          fmt::format("{}: run is '{}'; expected the name of a folder", list.string(), line));
    }
    runs.push_back(line);
  }
  return runs;
}

std::string StageOf(const std::string& run) { return run.substr(0, run.rfind('-')); }

namespace {

std::string ReadFirstLine(const fs::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  return line;
}

VariantResult ReadVariant(const fs::path& dataset, const fs::path& folder, DamagedFiles damaged) {
  VariantResult variant = {folder.filename().string(), folder};
  try {
    if (Exists(folder / "metrics.json")) {
      variant.metrics = ReadDescribed<Metrics>(folder / "metrics.json", "metrics").body;
    }
    for (const std::string& run : RunsIn(folder / "stages.txt")) {
      StageRun stage = {StageOf(run), dataset / "shared" / run, {}};
      const fs::path timing = stage.folder / "timing.json";
      if (Exists(timing)) {
        stage.timing = ReadDocument<StageTiming>(ParseJsonFile(timing), timing.string());
      }
      variant.stages.push_back(std::move(stage));
    }
    variant.shown_runs = RunsIn(folder / (Exists(folder / ".linked") ? ".linked" : "stages.txt"));
  } catch (const InputError& error) {
    if (damaged == DamagedFiles::kRefused) throw;
    variant.metrics.reset();
    variant.stages.clear();
    variant.unreadable = error.what();
  }
  return variant;
}

}  // namespace

std::string FailureIn(const fs::path& run_folder) { return ReadFirstLine(run_folder / "failed"); }

const VariantResult* DatasetResult::Evaluated(const std::string& variant) const {
  const auto found = std::ranges::find_if(variants, [&](const VariantResult& candidate) {
    return candidate.name == variant && candidate.metrics;
  });
  return found == variants.end() ? nullptr : &*found;
}

std::vector<std::string> ListSubfolders(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (IsFolder(entry.path())) names.push_back(entry.path().filename().string());
  }
  std::ranges::sort(names);
  return names;
}

fs::path ReadDatasetFolder(const fs::path& results_of_dataset) {
  return ReadFirstLine(results_of_dataset / "shared" / "dataset.txt");
}

std::vector<DatasetResult> ReadResults(const fs::path& results, DamagedFiles damaged) {
  std::vector<DatasetResult> datasets;
  for (const std::string& name : ListSubfolders(results)) {
    DatasetResult dataset = {name, {}};
    for (const std::string& variant : ListSubfolders(results / name)) {
      const fs::path folder = results / name / variant;
      if (!Exists(folder / "metrics.json") && !Exists(folder / "stages.txt")) continue;
      dataset.variants.push_back(ReadVariant(results / name, folder, damaged));
    }
    // Variants that are neither the paper's nor ours are equal in rank.
    std::ranges::stable_sort(dataset.variants, {}, [](const VariantResult& variant) {
      return std::ranges::find(kKnownVariants, variant.name) - kKnownVariants.begin();
    });
    if (!dataset.variants.empty()) datasets.push_back(std::move(dataset));
  }
  return datasets;
}

DatasetFacts ReadFacts(const DatasetResult& dataset, const fs::path& settings) {
  DatasetFacts facts;
  const auto with_sequence = std::ranges::find_if(
      dataset.variants,
      [](const VariantResult& variant) { return Exists(variant.folder / "sequence.json"); });
  if (with_sequence != dataset.variants.end()) {
    const Sequence sequence =
        ReadSequence(with_sequence->folder / "sequence.json", PlaneNeed::kNotNeeded);
    facts.odometry = sequence.odometry_source;
    facts.counts = {static_cast<int>(sequence.frames.size() + sequence.held_out.size())};
    for (const TrueObject& object : sequence.true_objects) {
      if (!object.IsWanted()) continue;
      ++facts.counts->objects;
      facts.counts->round_objects += object.truth.rotationally_symmetric ? 1 : 0;
    }
  }
  if (!settings.empty()) ReadAbout(settings / (dataset.name + ".json"), &facts);
  return facts;
}

std::map<int, double> ObjectValues(const VariantResult& variant, const ObjectMetric& metric) {
  std::map<int, double> values;
  for (const ObjectMetrics& object : variant.metrics->objects) {
    if (const auto value = metric.of(object).front()) values.emplace(object.object_index, *value);
  }
  return values;
}

std::string WhyUnfinished(const VariantResult& variant) {
  for (const StageRun& run : variant.stages) {
    const std::string failure = FailureIn(run.folder);
    if (!failure.empty()) return "failed: " + run.stage + ": " + failure;
    if (!Exists(run.folder / "done")) return "incomplete: " + run.stage + " has not run";
  }
  const bool is_older =
      !std::ranges::equal(variant.stages, variant.shown_runs, {},
                          [](const StageRun& run) { return run.folder.filename().string(); });
  return is_older ? "incomplete: its files are those of an earlier plan" : "";
}

bool ShowsStage(const VariantResult& variant, const std::string& stage, const std::string& file) {
  if (variant.shown_runs.empty()) return Exists(variant.folder / file);
  return std::ranges::any_of(variant.shown_runs,
                             [&](const std::string& run) { return StageOf(run) == stage; });
}

void ReadAbout(const std::filesystem::path& settings, DatasetFacts* facts) {
  if (!Exists(settings)) return;
  const nlohmann::json document = ParseJsonFile(settings);
  const nlohmann::json about =
      document.is_object() ? document.value("about", nlohmann::json()) : nlohmann::json();
  if (about.is_null()) return;
  static_cast<AboutDataset&>(*facts) =
      ReadDocument<AboutDataset>(about, settings.string() + ": about");
}

std::string FormatMarks(const DatasetFacts& facts, int objects) {
  std::vector<std::string> marks;
  if (objects <= kFewObjects) marks.emplace_back("f");
  if (facts.partly_annotated) marks.emplace_back("p");
  if (facts.counts && facts.counts->round_objects > 0) marks.emplace_back("r");
  return marks.empty() ? kNoValue : fmt::format("{}", fmt::join(marks, ", "));
}

std::string MarksNote() {
  return fmt::format(
      "Marks: f, few objects (at most {}); p, partly annotated: there are more things of such "
      "kinds; r, some objects have a round footprint: they have no Rot, and their true boxes take "
      "the yaw of the estimate.",
      kFewObjects);
}

std::string DifferencesInWords(const DatasetFacts& facts) {
  std::vector<std::string> parts;
  if (!facts.differs.empty()) parts.push_back(facts.differs);
  if (facts.counts) {
    parts.push_back(Counted(facts.counts->frames, "frame") + ", " +
                    Counted(facts.counts->objects, "annotated object"));
  }
  const auto add = [&](const char* what, const std::string& text) {
    if (!text.empty()) parts.push_back(fmt::format("{}: {}", what, text));
  };
  add("annotation", facts.annotation);
  add("boxes", facts.boxes);
  add("odometry", facts.odometry);
  return fmt::format("{}", fmt::join(parts, "; "));
}

}  // namespace soslam

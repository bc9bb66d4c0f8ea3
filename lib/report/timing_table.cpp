// SPDX-License-Identifier: BSD-3-Clause
#include "report/timing_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "artefact/json_file.h"
#include "base/error.h"
#include "base/paths.h"

namespace soslam {
namespace {

using nlohmann::json;

// One of the clocks of a timing, and the name of its rows.
struct Clock {
  const char* title;
  double StageTiming::*seconds;
};
constexpr Clock kWallClock = {"wall", &StageTiming::wall_s};
constexpr Clock kCpuClock = {"CPU", &StageTiming::cpu_s};

constexpr std::array kLandmarkStages = {"edges", "initialise", "refine"};
constexpr const char* kMapStage = "optimise";

std::optional<double> Seconds(const StageRun& run, const Clock& clock) {
  if (!run.timing) return std::nullopt;
  return (*run.timing).*clock.seconds;
}

// Sum over the runs; none if a run has no timing, or if there are no runs.
std::optional<double> TotalSeconds(const std::vector<StageRun>& runs, const Clock& clock) {
  double total = 0.0;
  for (const StageRun& run : runs) {
    const auto seconds = Seconds(run, clock);
    if (!seconds) return std::nullopt;
    total += *seconds;
  }
  return runs.empty() ? std::nullopt : std::optional(total);
}

// The runs that are counted in the time per landmark.
std::vector<StageRun> LandmarkRuns(const VariantResult& variant, bool is_map) {
  std::vector<StageRun> runs;
  for (const StageRun& run : variant.stages) {
    const bool counts =
        is_map ? run.stage == kMapStage
               : std::ranges::find(kLandmarkStages, run.stage) != kLandmarkStages.end();
    if (counts) runs.push_back(run);
  }
  return runs;
}

std::string MachineText(const StageTiming& timing) {
  if (!timing.machine) return "not recorded";
  return fmt::format("{}, {} cores, {} threads", timing.machine->cpu, timing.machine->cores,
                     timing.threads);
}

// The runs of all variants.
std::vector<StageRun> RunsOf(const std::vector<DatasetResult>& datasets) {
  std::vector<StageRun> runs;
  for (const DatasetResult& dataset : datasets) {
    for (const VariantResult& variant : dataset.variants) {
      runs.insert(runs.end(), variant.stages.begin(), variant.stages.end());
    }
  }
  return runs;
}

std::string MachineNote(const std::vector<DatasetResult>& datasets) {
  std::set<std::string> machines;
  for (const StageRun& run : RunsOf(datasets)) {
    if (run.timing) machines.insert(MachineText(*run.timing));
  }
  return fmt::format("Measured on: {}.", fmt::join(machines, "; "));
}

struct TimeRow {
  const char* title;
  double LandmarkTime::*value;
};
constexpr std::array<TimeRow, 3> kTimeRows = {{{"wall ms", &LandmarkTime::wall_ms},
                                               {"CPU ms", &LandmarkTime::cpu_ms},
                                               {"observations", &LandmarkTime::observations}}};

// Times in the order of KnownVariants(). Variants share sequences, which can be large: each is read
// once.
std::vector<std::optional<LandmarkTime>> TimesOf(const DatasetResult& dataset) {
  std::map<std::filesystem::path, SequenceCounts> counts;
  std::vector<std::optional<LandmarkTime>> times;
  for (const std::string& name : KnownVariants()) {
    const VariantResult* const variant = dataset.Evaluated(name);
    times.emplace_back();
    if (!variant || !Exists(variant->folder / "sequence.json")) continue;
    const auto file = std::filesystem::canonical(variant->folder / "sequence.json");
    if (!counts.contains(file)) counts[file] = CountObservations(file);
    times.back() = TimePerLandmark(*variant, counts[file]);
  }
  return times;
}

void AddMeasuredTimes(const DatasetResult& dataset, Table* table) {
  const std::vector<std::optional<LandmarkTime>> times = TimesOf(dataset);
  const bool any = std::ranges::any_of(times, [](const auto& time) { return time.has_value(); });
  if (!any) return;
  for (const TimeRow& time_row : kTimeRows) {
    std::vector<Cell> row = {dataset.name, time_row.title};
    for (const auto& time : times) {
      row.emplace_back(time ? fmt::format("{:.1f}", (*time).*time_row.value) : kNoValue);
    }
    table->rows.push_back(std::move(row));
  }
}

void AddPublishedTimes(const PublishedTimes& published, Table* table) {
  if (published.values.empty()) return;
  std::vector<Cell> times = {published.dataset, "published ms"};
  std::vector<Cell> observations = {published.dataset, "published observations"};
  for (const std::string& name : KnownVariants()) {
    const auto time = std::ranges::find(published.values, name, &PublishedTime::variant);
    const bool is_published = time != published.values.end();
    times.emplace_back(is_published ? fmt::format("{:.1f} ± {:.1f}", time->ms_mean, time->ms_sigma)
                                    : kNoValue);
    observations.emplace_back(is_published ? fmt::format("{:.1f}", time->observations) : kNoValue);
  }
  table->rows.push_back(std::move(times));
  table->rows.push_back(std::move(observations));
  table->notes.push_back(fmt::format("Published: {}, on {}.", published.source, published.machine));
}

// Stages that any variant has, in the order of the pipeline.
std::vector<std::string> StagesOf(const std::vector<DatasetResult>& datasets) {
  const std::vector<StageRun> runs = RunsOf(datasets);
  std::vector<std::string> stages = {"import",     "ground", "associate", "planes",  "edges",
                                     "initialise", "refine", "optimise",  "evaluate"};
  std::erase_if(stages, [&](const std::string& stage) {
    return std::ranges::find(runs, stage, &StageRun::stage) == runs.end();
  });
  return stages;
}

std::vector<Cell> StageTimeRow(const std::string& dataset, const VariantResult& variant,
                               const std::vector<std::string>& stages, const Clock& clock) {
  const auto cell = [](const std::optional<double>& seconds) {
    return Cell(seconds ? fmt::format("{:.3f}", *seconds) : kNoValue);
  };
  std::vector<Cell> row = {dataset, variant.name, clock.title};
  for (const std::string& stage : stages) {
    const auto run = std::ranges::find(variant.stages, stage, &StageRun::stage);
    row.push_back(cell(run == variant.stages.end() ? std::nullopt : Seconds(*run, clock)));
  }
  row.push_back(cell(TotalSeconds(variant.stages, clock)));
  return row;
}

}  // namespace

SequenceCounts CountObservations(const std::filesystem::path& sequence_file) {
  const json sequence = ParseJsonFile(sequence_file);
  std::set<json> objects;
  try {
    for (const json& detection : sequence.at("detections")) objects.insert(detection.at("object"));
    return {static_cast<int>(sequence.at("detections").size()), static_cast<int>(objects.size())};
  } catch (const json::exception& error) {
    throw InputError(fmt::format("{}: expected detections, each of an object: {}",
                                 sequence_file.string(), error.what()));
  }
}

std::optional<LandmarkTime> TimePerLandmark(const VariantResult& variant,
                                            const SequenceCounts& counts) {
  if (variant.metrics.is_null()) return std::nullopt;
  const bool is_map =
      std::ranges::find(variant.stages, kMapStage, &StageRun::stage) != variant.stages.end();
  const std::vector<StageRun> runs = LandmarkRuns(variant, is_map);
  const auto wall_s = TotalSeconds(runs, kWallClock);
  const auto cpu_s = TotalSeconds(runs, kCpuClock);
  if (!wall_s || !cpu_s) return std::nullopt;
  const bool is_single_frame = !variant.metrics.at("first_observation").is_null();
  const int landmarks = is_single_frame ? counts.observations : counts.objects;
  if (landmarks == 0) return std::nullopt;
  return LandmarkTime{1e3 * *wall_s / landmarks, 1e3 * *cpu_s / landmarks,
                      static_cast<double>(counts.observations) / landmarks};
}

Table TimeTable(const std::vector<DatasetResult>& datasets, const Published& published) {
  Table table = {"table_5_time", "Time per landmark (Table V)", {"dataset", "values"}, {}, 2, {}};
  for (const std::string& name : KnownVariants()) table.header.push_back(name);
  for (const DatasetResult& dataset : datasets) AddMeasuredTimes(dataset, &table);
  if (table.rows.empty()) return table;
  table.notes = {
      MachineNote(datasets),
      "Edges, initialisation and refinement per landmark, of which single-frame variants "
      "have one per observation; of maps the back end alone, per object."};
  AddPublishedTimes(published.times, &table);
  return table;
}

Table StageTimeTable(const std::vector<DatasetResult>& datasets) {
  Table table = {
      "table_5_time_by_stage", "Seconds by stage (Table V)", {"dataset", "variant", "clock"}, {}, 3,
      {MachineNote(datasets)}};
  const std::vector<std::string> stages = StagesOf(datasets);
  table.header.insert(table.header.end(), stages.begin(), stages.end());
  table.header.emplace_back("all");
  for (const DatasetResult& dataset : datasets) {
    for (const VariantResult& variant : dataset.variants) {
      const bool is_timed = std::ranges::any_of(
          variant.stages, [](const StageRun& run) { return run.timing.has_value(); });
      if (!is_timed) continue;
      table.rows.push_back(StageTimeRow(dataset.name, variant, stages, kWallClock));
      table.rows.push_back(StageTimeRow(dataset.name, variant, stages, kCpuClock));
    }
  }
  return table;
}

}  // namespace soslam

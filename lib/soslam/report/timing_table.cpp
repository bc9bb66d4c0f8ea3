// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "soslam/artefact/files.h"
#include "soslam/base/paths.h"
#include "soslam/report/tables.h"

namespace soslam {
namespace {

constexpr std::array kLandmarkStages = {"edges", "track", "appearance", "initialise", "refine"};
constexpr const char* kMapStage = "optimise";

// Variants share sequences, which can be large: each is read once.
void AddMeasuredTimes(const DatasetResult& dataset, Table* table) {
  std::map<std::filesystem::path, SequenceCounts> counts;
  std::vector<Cell> wall = {dataset.name, "wall ms"}, cpu = {dataset.name, "CPU ms"};
  std::vector<Cell> observations = {dataset.name, "observations"};
  bool is_measured = false;
  for (const char* name : kKnownVariants) {
    const VariantResult* const variant = dataset.Evaluated(name);
    std::optional<LandmarkTime> time;
    if (variant && Exists(variant->folder / "sequence.json")) {
      const auto file = std::filesystem::canonical(variant->folder / "sequence.json");
      if (!counts.contains(file)) counts[file] = CountObservations(file);
      time = TimePerLandmark(*variant, counts[file]);
    }
    const auto add = [&](double LandmarkTime::*value, std::vector<Cell>* row) {
      row->emplace_back(time ? fmt::format("{:.1f}", (*time).*value) : kNoValue);
    };
    add(&LandmarkTime::wall_ms, &wall);
    add(&LandmarkTime::cpu_ms, &cpu);
    add(&LandmarkTime::observations, &observations);
    is_measured |= time.has_value();
  }
  if (is_measured) table->rows.insert(table->rows.end(), {wall, cpu, observations});
}

}  // namespace

SequenceCounts CountObservations(const std::filesystem::path& sequence_file) {
  const Sequence sequence = ReadSequence(sequence_file, PlaneNeed::kNotNeeded);
  std::set<int> objects;
  for (const Detection& detection : sequence.detections) objects.insert(detection.object_index);
  return {static_cast<int>(sequence.detections.size()), static_cast<int>(objects.size())};
}

std::optional<LandmarkTime> TimePerLandmark(const VariantResult& variant,
                                            const SequenceCounts& counts) {
  if (!variant.metrics) return std::nullopt;
  const bool is_map =
      std::ranges::find(variant.stages, kMapStage, &StageRun::stage) != variant.stages.end();
  double wall_s = 0.0, cpu_s = 0.0;
  int runs = 0;
  for (const StageRun& run : variant.stages) {
    const bool counts_here =
        is_map ? run.stage == kMapStage
               : std::ranges::find(kLandmarkStages, run.stage) != kLandmarkStages.end();
    if (!counts_here) continue;
    if (!run.timing) return std::nullopt;
    wall_s += run.timing->wall_s;
    cpu_s += run.timing->cpu_s;
    ++runs;
  }
  const bool is_single_frame = variant.metrics->first_observation.has_value();
  const int landmarks = is_single_frame ? counts.observations : counts.objects;
  if (runs == 0 || landmarks == 0) return std::nullopt;
  return LandmarkTime{1e3 * wall_s / landmarks, 1e3 * cpu_s / landmarks,
                      static_cast<double>(counts.observations) / landmarks};
}

Table TimeTable(const std::vector<DatasetResult>& datasets, const Published& published) {
  Table table = {"table_5_time", "Time per landmark (Table V)", {"dataset", "values"}, {}, 2, {}};
  for (const char* name : kKnownVariants) table.header.emplace_back(name);
  for (const DatasetResult& dataset : datasets) AddMeasuredTimes(dataset, &table);
  if (table.rows.empty()) return table;
  std::set<std::string> machines;
  for (const DatasetResult& dataset : datasets) {
    for (const VariantResult& variant : dataset.variants) {
      for (const StageRun& run : variant.stages) {
        if (!run.timing) continue;
        const auto& machine = run.timing->machine;
        machines.insert(machine ? fmt::format("{}, {} cores, {} threads", machine->cpu,
                                              machine->cores, run.timing->threads)
                                : "not recorded");
      }
    }
  }
  table.notes = {
      fmt::format("Measured on: {}. Stages that ran side by side have longer wall times.",
                  fmt::join(machines, "; ")),
      "Edges, tracks, initialisation and refinement per landmark, of which single-frame "
      "variants have one per observation; of maps the back end alone, per object."};
  const PublishedTimes& times = published.times;
  if (times.values.empty()) return table;
  std::vector<Cell> ms = {times.dataset, "published ms"};
  std::vector<Cell> observations = {times.dataset, "published observations"};
  for (const char* name : kKnownVariants) {
    const auto time = std::ranges::find(times.values, name, &PublishedTime::variant);
    const bool is_published = time != times.values.end();
    ms.emplace_back(is_published ? fmt::format("{:.1f} ± {:.1f}", time->ms_mean, time->ms_sigma)
                                 : kNoValue);
    observations.emplace_back(is_published ? fmt::format("{:.1f}", time->observations) : kNoValue);
  }
  table.rows.push_back(std::move(ms));
  table.rows.push_back(std::move(observations));
  table.notes.push_back(fmt::format("Published: {}, on {}.", times.source, times.machine));
  return table;
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/workflow/pipeline_stages.h"

#include <algorithm>
#include <utility>

#include "soslam/artefact/options_json.h"
#include "soslam/association/options.h"
#include "soslam/cli/command_line.h"
#include "soslam/dataset/import_options.h"
#include "soslam/evaluation/alignment.h"
#include "soslam/ground/options.h"
#include "soslam/image/edge_maps.h"
#include "soslam/image/feature_matches.h"
#include "soslam/image/feature_tracks.h"
#include "soslam/initialisation/options.h"
#include "soslam/mapping/options.h"
#include "soslam/orientation/options.h"
#include "soslam/planes/options.h"

namespace soslam {
namespace {

using nlohmann::json;

// Defaults of an options struct overwritten by `values`.
template <typename Options>
json Resolve(const json& values, const std::string& where) {
  Options options;
  OptionsFromJson(values, where, &options);
  return OptionsToJson(options);
}

template <typename Options>
PipelineStage Stage(const char* name, std::vector<StageInput> inputs,
                    std::map<std::string, std::string> other_inputs,
                    std::vector<StageOutput> outputs, const char* asked_by = nullptr,
                    bool takes_edits = false) {
  return {name,
          &Resolve<Options>,
          &OptionRows<Options>,
          std::move(inputs),
          std::move(other_inputs),
          std::move(outputs),
          asked_by,
          takes_edits};
}

std::vector<PipelineStage> MakeStages() {
  const std::pair<std::string, std::string> dataset = {"dataset", "$(dataset)"};
  const std::pair<std::string, std::string> table = {"table", "$(pipelines)/{}"};
  const StageInput imported = {"sequence", {"import"}};
  const StageInput sequence = {"sequence", {"planes", "associate", "ground", "import"}};
  const StageInput initial = {"initial", {"initialise"}};
  const StageInput edges = {"edges", {"edges"}};
  const StageInput edges_of_cuboids = {"edges", {"edges"}, {{"method", "cuboid_proposals"}}};
  const StageInput edges_of_symmetry = {
      "edges", {"edges"}, {{"symmetry", true}, {"edge_alignment", true}}};
  const StageInput points = {"points", {"track"}, {{"point_evidence", true}}};
  const StageInput matches = {"matches", {"match"}, {{"shared_points", true}}, /*adds_maker=*/true};
  const StageInput appearance = {
      "appearance", {"appearance"}, {{"picture_yaw", true}, {"picture_ratios", true}}};
  const StageInput start = {"landmarks", {"refine", "initialise"}};
  const StageInput landmarks = {"landmarks", {"optimise", "refine", "initialise"}};
  const StageOutput sequence_file = {"output", "sequence.json"};
  return {
      Stage<ImportOptions>("import", {}, {dataset}, {sequence_file}),
      // Neither matches nor points nor edge maps depend on the world or its unit.
      Stage<MatchOptions>("match", {imported}, {dataset}, {{"output", "matches.h5"}}),
      Stage<GroundOptions>("ground", {sequence, matches},
                           {dataset, {"points", "$(dataset)/points.h5"}, table},
                           {sequence_file, {"world", "world.json"}}, "ground",
                           /*takes_edits=*/true),
      Stage<AssociateOptions>("associate", {sequence, matches}, {table},
                              {sequence_file, {"associations", "associations.json"}}, "association",
                              /*takes_edits=*/true),
      Stage<PlanesOptions>("planes", {sequence}, {dataset, table},
                           {sequence_file, {"report", "planes.json"}}, "planes"),
      Stage<EdgesOptions>("edges", {imported}, {dataset}, {{"output", "edges.h5"}}),
      Stage<TrackOptions>("track", {imported}, {dataset}, {{"output", "points.h5"}}),
      Stage<NoOptions>("appearance", {sequence},
                       {dataset,
                        {"head", std::string("$(pipelines)/") + kHeadFile},
                        {"network", "\"$$SOSLAM_NETWORK\""}},
                       {{"output", "appearance.h5"}}),
      Stage<InitialiseOptions>("initialise", {sequence, edges_of_cuboids, points, appearance},
                               {table}, {{"output", "initial.json"}}),
      Stage<OrientationOptions>("refine", {sequence, edges, initial, points, appearance}, {table},
                                {{"output", "refined.json"}, {"curves", "symmetry.h5"}}),
      Stage<OptimiseOptions>("optimise", {sequence, edges_of_symmetry, start, points, appearance},
                             {table}, {{"output", "map.json"}}),
      Stage<EvaluateOptions>("evaluate", {sequence, landmarks}, {}, {{"output", "metrics.json"}})};
}

}  // namespace

const std::vector<PipelineStage>& Stages() {
  static const std::vector<PipelineStage> stages = MakeStages();
  return stages;
}

const PipelineStage* FindStage(const std::string& name) {
  const auto found = std::ranges::find(Stages(), name, &PipelineStage::name);
  return found == Stages().end() ? nullptr : &*found;
}

std::vector<StageOutput> OutputsOfStage(const std::string& stage) {
  const PipelineStage* found = FindStage(stage);
  return found == nullptr ? std::vector<StageOutput>() : found->outputs;
}

std::optional<std::string> AskingSetting(const StageInput& input, const json& settings) {
  if (input.asked_by.empty()) return "";
  for (const auto& [name, value] : input.asked_by) {
    if (settings.at(name) != value) continue;
    return name + " = " + (value.is_string() ? value.get<std::string>() : value.dump());
  }
  return std::nullopt;
}

std::vector<std::string> PipelineStages() {
  std::vector<std::string> names;
  for (const PipelineStage& stage : Stages()) names.emplace_back(stage.name);
  return names;
}

}  // namespace soslam

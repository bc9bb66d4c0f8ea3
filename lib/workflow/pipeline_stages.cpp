// SPDX-License-Identifier: BSD-3-Clause
#include "workflow/pipeline_stages.h"

#include <algorithm>
#include <utility>

#include "association/options.h"
#include "dataset/import_options.h"
#include "evaluation/alignment.h"
#include "ground/options.h"
#include "image/edge_maps.h"
#include "image/feature_tracks.h"
#include "initialisation/options.h"
#include "mapping/options.h"
#include "orientation/options.h"
#include "planes/options.h"

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
PipelineStage Stage(const char* name, std::vector<std::string> needs,
                    std::set<std::string> other_inputs, std::vector<StageOutput> outputs,
                    const char* asked_by = nullptr) {
  return {name,
          &Resolve<Options>,
          &OptionRows<Options>,
          std::move(needs),
          std::move(other_inputs),
          std::move(outputs),
          asked_by};
}

}  // namespace

const std::vector<PipelineStage>& Stages() {
  static const StageOutput sequence = {"output", "sequence.json"};
  static const std::vector<PipelineStage> stages = {
      Stage<ImportOptions>("import", {}, {"dataset"}, {sequence}),
      Stage<GroundOptions>("ground", {"import"}, {"dataset", "table"},
                           {sequence, {"world", "world.json"}}, "ground"),
      Stage<AssociateOptions>("associate", {"import"}, {"table"},
                              {sequence, {"associations", "associations.json"}}, "association"),
      Stage<PlanesOptions>("planes", {"import"}, {"dataset", "table"},
                           {sequence, {"report", "planes.json"}}, "planes"),
      Stage<EdgesOptions>("edges", {"import"}, {"dataset"}, {{"output", "edges.h5"}}),
      Stage<TrackOptions>("track", {"import"}, {"dataset"}, {{"output", "points.h5"}}),
      Stage<InitialiseOptions>("initialise", {"import"}, {"table"}, {{"output", "initial.json"}}),
      Stage<OrientationOptions>("refine", {"import", "initialise", "edges"}, {"table"},
                                {{"output", "refined.json"}, {"curves", "symmetry.h5"}}),
      Stage<OptimiseOptions>("optimise", {"import", "initialise"}, {"table"},
                             {{"output", "map.json"}}),
      Stage<EvaluateOptions>("evaluate", {"import", "initialise"}, {},
                             {{"output", "metrics.json"}})};
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

bool StageReads(const std::string& stage, const std::string& input) {
  const PipelineStage* found = FindStage(stage);
  return found != nullptr && found->other_inputs.contains(input);
}

bool UsesImages(const std::string& stage, const json& settings) {
  if (stage == "initialise") return settings.at("method") == "cuboid_proposals";
  if (stage == "optimise") {
    return settings.at("symmetry") == true || settings.at("edge_alignment") == true;
  }
  return stage == "refine";
}

bool UsesPoints(const json& settings) { return settings.value("point_evidence", false); }

std::vector<std::string> PipelineStages() {
  std::vector<std::string> names;
  for (const PipelineStage& stage : Stages()) names.emplace_back(stage.name);
  return names;
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "base/options.h"

namespace soslam {

// An output of a stage: argument name and file name.
struct StageOutput {
  std::string argument;
  std::string file;
};

// A stage that variants may run.
struct PipelineStage {
  const char* name;
  // All options, with these values in place of their defaults. Throws SettingsError, naming
  // `where`.
  nlohmann::json (*resolve)(const nlohmann::json& values, const std::string& where);
  std::vector<OptionRow> (*rows)();
  std::vector<std::string> needs;      // stages whose artefacts it reads
  std::set<std::string> other_inputs;  // arguments: "dataset" and "table"
  std::vector<StageOutput> outputs;
  // Its setting that asks for it unless it is "given"; null for a stage that 'stages' lists.
  const char* asked_by = nullptr;
};

// In order of execution.
const std::vector<PipelineStage>& Stages();
const PipelineStage* FindStage(const std::string& name);

// The names of all stages.
std::vector<std::string> PipelineStages();
// Empty for programs that are not stages of a plan.
std::vector<StageOutput> OutputsOfStage(const std::string& stage);

// True if a stage of a plan gets the dataset's folder as `input` "dataset", the semantic table as
// "table".
bool StageReads(const std::string& stage, const std::string& input);

// True if a stage with these (resolved) settings reads the edge maps of images.
bool UsesImages(const std::string& stage, const nlohmann::json& settings);
// True if a stage with these (resolved) settings uses sparse points as evidence.
bool UsesPoints(const nlohmann::json& settings);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "soslam/artefact/options_json.h"

namespace soslam {

// Head of soslam-appearance, relative to the pipelines folder.
inline constexpr const char* kHeadFile = "heads/yolox_nano.h5";

// An output of a stage: argument name and file name.
struct StageOutput {
  std::string argument;
  std::string file;
};

// An artefact that a stage reads.
struct StageInput {
  std::string argument;             // "landmarks"
  std::vector<std::string> makers;  // the first of these stages that has run writes it
  // Settings of the reading stage with the values that ask for it, one of which suffices; none: it
  // is always read.
  std::vector<std::pair<std::string, nlohmann::json>> asked_by = {};
  bool adds_maker = false;  // what asks for it makes its maker run, which 'stages' need not list
};

// A stage that variants may run.
struct PipelineStage {
  const char* name;
  // All options, with these values in place of their defaults. Throws SettingsError, naming
  // `where`.
  nlohmann::json (*resolve)(const nlohmann::json& values, const std::string& where);
  std::vector<OptionRow> (*rows)();
  std::vector<StageInput> inputs;
  // Paths in a makefile by argument; {} stands for the name of the semantic table.
  std::map<std::string, std::string> other_inputs;
  std::vector<StageOutput> outputs;
  // Its setting that asks for it unless it is "given"; null for a stage that 'stages' lists.
  const char* asked_by = nullptr;
  bool takes_edits = false;  // see kEditsFile
};

// In order of execution.
const std::vector<PipelineStage>& Stages();
const PipelineStage* FindStage(const std::string& name);  // null if there is none

// The names of all stages.
std::vector<std::string> PipelineStages();
// Empty for programs that are not stages of a plan.
std::vector<StageOutput> OutputsOfStage(const std::string& stage);

// The setting that asks for an input, with its value: "symmetry = true". Empty text: read without
// any; nothing: not read with these (resolved) settings.
std::optional<std::string> AskingSetting(const StageInput& input, const nlohmann::json& settings);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "model/finding.h"

namespace soslam {

// Stages and settings of a variant on a dataset.
struct VariantSettings {
  // Every option, resolved, keyed by stage; also of stages that a setting asks for.
  std::map<std::string, nlohmann::json> options;
  std::string semantic_table;       // path relative to the pipelines folder
  std::string semantic_table_file;  // the settings file that names it
  std::vector<Finding> findings;    // settings without effect
  // The same for settings of the dataset for stages that this variant does not run, but others may.
  std::vector<Finding> for_others;
};

// All stages that a variant may run, in order of execution.
std::vector<std::string> PipelineStages();

// An output of a stage: argument name and file name. OutputsOfStage is empty for programs that are
// not stages of a plan.
struct StageOutput {
  std::string argument;
  std::string file;
};
std::vector<StageOutput> OutputsOfStage(const std::string& stage);

// True if a stage of a plan gets the dataset's folder as `input` "dataset", the semantic table as
// "table".
bool StageReads(const std::string& stage, const std::string& input);

// The names of all pipelines/variants/<name>.json, sorted. Throws SettingsError when there are
// none.
std::vector<std::string> VariantNames(const std::filesystem::path& pipelines);

// Reads the settings of a variant: pipelines/base.json < datasets/<dataset>.json (if any) <
// variants/<variant>.json, merged as JSON merge patches (RFC 7396). A variant with "extends":
// "<path>" is merged after the variant in <path>.json, relative to its own folder. Throws
// SettingsError, naming the file, for a missing or malformed file, an unknown stage or setting, a
// value out of range, and stages whose inputs no stage writes. "about" (schemas/about.schema.json)
// is for tables and has no effect on results.
VariantSettings ReadVariant(const std::filesystem::path& pipelines, const std::string& dataset,
                            const std::string& variant);

// Files in pipelines/datasets that are not read because of the case or the ending of their names,
// where the dataset has no settings: Room.json, room.json.txt.
std::vector<Finding> CheckNamesOfSettings(const std::filesystem::path& pipelines,
                                          const std::string& dataset);

// True if a stage with these (resolved) settings reads the edge maps of images.
bool UsesImages(const std::string& stage, const nlohmann::json& settings);
// True if a stage with these (resolved) settings uses sparse points as evidence.
bool UsesPoints(const nlohmann::json& settings);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "soslam/model/finding.h"

namespace soslam {

// Every option of the stages that run, resolved, keyed by stage; also of stages that a setting asks
// for.
using StageOptions = std::map<std::string, nlohmann::json>;

// Stages and settings of a variant on a dataset.
struct VariantSettings {
  StageOptions options;
  std::string semantic_table;       // path relative to the pipelines folder
  std::string semantic_table_file;  // the settings file that names it
  std::vector<Finding> findings;    // settings without effect
  // Settings of the dataset for stages that this variant does not run, but others may.
  std::vector<Finding> for_others;
};

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

}  // namespace soslam

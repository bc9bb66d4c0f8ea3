// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "soslam/workflow/pipeline_settings.h"

namespace soslam {

// A file of settings of stages.
struct SettingsOfFile {
  std::filesystem::path file;
  nlohmann::json settings;
};

// Adds the findings on settings without effect of a variant's own file, or of the file of the
// dataset, to those of the variant. A variant is for all datasets: one may rule out what it has for
// others. The settings of a dataset are for all variants, unless they rule out each other. `alone`
// are the options without the dataset's file, or with that file only.
void CheckUnusedSettings(const SettingsOfFile& layer, const StageOptions& alone, bool is_of_dataset,
                         VariantSettings* settings);

// Files in pipelines/datasets that are not read because of the case or the ending of their names,
// where the dataset has no settings: Room.json, room.json.txt.
std::vector<Finding> CheckNamesOfSettings(const std::filesystem::path& pipelines,
                                          const std::string& dataset);

}  // namespace soslam

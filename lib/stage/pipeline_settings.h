// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

namespace soslam {

// What a variant runs on a dataset.
struct VariantSettings {
  std::set<std::string> stages;  // with those that a setting asks for
  std::map<std::string, nlohmann::json> options;  // by stage of `stages`: every option, resolved
  std::string semantic_table;                     // path relative to the pipelines folder
};

// The stages that a variant may run, in the order in which they do.
std::vector<std::string> PipelineStages();

// The names of all pipelines/variants/<name>.json, sorted. Throws SettingsError when there are
// none.
std::vector<std::string> VariantNames(const std::filesystem::path& pipelines);

// pipelines/base.json < datasets/<dataset>.json (if any) < variants/<variant>.json, merged as JSON
// merge patches (RFC 7396). A variant with "extends": "<path>" comes after the variant in
// <path>.json, relative to its own folder. Throws SettingsError, naming the file, for a missing or
// malformed file, an unknown stage or setting, a value out of range, and stages that lack what they
// read.
VariantSettings ReadVariant(const std::filesystem::path& pipelines, const std::string& dataset,
                            const std::string& variant);

// Whether the back end with these (resolved) settings looks at images.
bool UsesImages(const nlohmann::json& optimise_settings);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "soslam/artefact/options_json.h"
#include "soslam/base/paths.h"
#include "soslam/base/text.h"
#include "soslam/cli/command_line.h"
#include "soslam/workflow/pipeline_settings.h"
#include "soslam/workflow/pipeline_stages.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// The conditions that a setting lacks to have an effect. None if it has one, or if its stage runs
// only in other variants, which list it in 'stages'.
OptionVisitor::Conditions FindUnmetConditions(const PipelineStage& stage, const std::string& name,
                                              const StageOptions& options) {
  const std::vector<OptionRow> rows = stage.rows();
  const auto of_stage = options.find(stage.name);
  if (of_stage != options.end()) return UnmetConditions(rows, of_stage->second, name);
  if (stage.asked_by == nullptr || name == stage.asked_by) return {};
  const auto unmet = UnmetConditions(rows, stage.resolve(json::object(), stage.name), name);
  if (!unmet.empty()) return unmet;
  std::vector<std::string> asking =
      std::ranges::find(rows, stage.asked_by, &OptionRow::name)->choices;
  std::erase(asking, "given");
  return {{stage.asked_by, asking}};
}

}  // namespace

void CheckUnusedSettings(const SettingsOfFile& layer, const StageOptions& alone, bool is_of_dataset,
                         VariantSettings* settings) {
  for (const auto& section : layer.settings.items()) {
    const std::string& key = section.key();
    const json& values = section.value();
    const PipelineStage* stage = FindStage(key);
    if (stage == nullptr || !values.is_object()) continue;
    for (const auto& [name, value] : values.items()) {
      const auto unmet = FindUnmetConditions(*stage, name, settings->options);
      if (value.is_null() || unmet.empty()) continue;
      const Finding finding =
          SettingWithoutEffect(layer.file.string() + ": " + key, name, value, unmet);
      const bool is_said = !is_of_dataset || std::ranges::any_of(unmet, [&](const auto& condition) {
        return values.contains(condition.option);
      });
      if (is_said && !FindUnmetConditions(*stage, name, alone).empty()) {
        settings->findings.push_back(finding);
      } else if (is_of_dataset && !settings->options.contains(key)) {
        settings->for_others.push_back(finding);
      }
    }
  }
}

std::vector<Finding> CheckNamesOfSettings(const fs::path& pipelines, const std::string& dataset) {
  const fs::path expected = pipelines / "datasets" / (dataset + ".json");
  if (Exists(expected)) return {};
  const std::set<std::string> endings = {".json", ".jsonc", ".json5", ".txt"};
  std::vector<Finding> findings;
  std::error_code error;  // there are no settings of datasets at all
  for (const auto& entry : fs::directory_iterator(expected.parent_path(), error)) {
    fs::path name = LowerCase(entry.path().filename().string());
    while (endings.contains(name.extension().string())) name = name.stem();
    if (name != LowerCase(dataset)) continue;
    findings.push_back({"name_of_settings", Severity::kWarning,
                        fmt::format("{} is not read", entry.path().string()),
                        fmt::format("the settings of dataset {} in {}", dataset, expected.string()),
                        "another case or ending of the name; some systems hide endings",
                        "rename the file"});
  }
  return findings;
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/semantic_table_file.h"

#include "artefact/json_file.h"
#include "artefact/schema.h"

namespace soslam {
namespace {

Eigen::Vector2d Ratio(const nlohmann::json& entry) {
  return {entry.at("a_by_c").get<double>(), entry.at("b_by_c").get<double>()};
}

}  // namespace

SemanticTable ReadSemanticTable(const std::filesystem::path& path) {
  const nlohmann::json json = ParseJsonFile(path);
  ValidateAgainstSchema(json, "semantic_table", path.string());
  SemanticTable table;
  for (const auto& item : json.at("labels").items()) table.ratios[item.key()] = Ratio(item.value());
  if (json.contains("default")) table.default_ratio = Ratio(json.at("default"));
  return table;
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/semantic_table_file.h"

#include "artefact/json_file.h"
#include "artefact/schema.h"

namespace soslam {
namespace {

// Of entries that state a ratio only; the schema says the same.
constexpr double kDefaultLogSigma = 0.3;
constexpr double kDefaultShapeExponent = 1.1;

ShapePrior Prior(const nlohmann::json& entry) {
  return {{entry.at("a_by_c").get<double>(), entry.at("b_by_c").get<double>()},
          {entry.value("a_by_c_log_sigma", kDefaultLogSigma),
           entry.value("b_by_c_log_sigma", kDefaultLogSigma)},
          entry.value("shape_exponent", kDefaultShapeExponent)};
}

}  // namespace

SemanticTable ReadSemanticTable(const std::filesystem::path& path) {
  const nlohmann::json json = ParseJsonFile(path);
  ValidateAgainstSchema(json, "semantic_table", path.string());
  SemanticTable table;
  for (const auto& item : json.at("labels").items()) table.priors[item.key()] = Prior(item.value());
  if (json.contains("default")) table.default_prior = Prior(json.at("default"));
  return table;
}

}  // namespace soslam

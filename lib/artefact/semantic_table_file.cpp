// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <string>

#include "artefact/files.h"
#include "artefact/json_file.h"
#include "artefact/model_json.h"
#include "base/error.h"

namespace soslam {
namespace {

using nlohmann::json;

constexpr const char* kSemanticTableKind = "semantic_table";

// Defaults of entries that have a ratio only; the schema documents the same values.
constexpr double kDefaultLogSigma = 0.3;
constexpr double kDefaultShapeExponent = 1.1;

ShapePrior Prior(const json& entry) {
  ShapePrior prior = {{entry.at("a_by_c").get<double>(), entry.at("b_by_c").get<double>()},
                      {entry.value("a_by_c_log_sigma", kDefaultLogSigma),
                       entry.value("b_by_c_log_sigma", kDefaultLogSigma)},
                      ShapeExponentsFromJson(entry, kDefaultShapeExponent),
                      entry.value("log_correlation", 0.0),
                      {},
                      EnumFromName<Mount>(kMountNames, entry.value("mount", kMountNames.front()))};
  if (entry.contains("height_m")) {
    prior.height_m = {entry.at("height_m").get<double>(),
                      entry.value("height_log_sigma", kDefaultLogSigma)};
  }
  prior.edge_bias = entry.value("edge_bias", EdgeBias());
  prior.attitude =
      EnumFromName<Attitude>(kAttitudeNames, entry.value("attitude", kAttitudeNames.front()));
  return prior;
}

// `where` is that of the entry in its file, for error messages.
SemanticRow Row(const std::string& label, const json& entry, const std::string& where) {
  const ShapePrior prior = Prior(entry);
  if (prior.attitude != Attitude::kStanding && prior.mount != Mount::kStanding) {
    throw InputError(
        fmt::format("{}: attitude is {} and mount {}; expected standing for one of the two", where,
                    kAttitudeNames[static_cast<size_t>(prior.attitude)],
                    kMountNames[static_cast<size_t>(prior.mount)]));
  }
  return {label, entry.value("aliases", std::vector<std::string>()), prior,
          entry.value("samples", 0), entry.at("source").get<std::string>()};
}

json Entry(const SemanticRow& row) {
  const ShapePrior& prior = row.prior;
  json entry = {{"a_by_c", prior.ratio.x()},
                {"b_by_c", prior.ratio.y()},
                {"a_by_c_log_sigma", prior.log_sigma.x()},
                {"b_by_c_log_sigma", prior.log_sigma.y()},
                {"log_correlation", prior.log_correlation},
                {"shape_exponent", prior.shape_exponents.horizontal},
                {"samples", row.samples},
                {"source", row.source}};
  if (prior.shape_exponents.HasAxis()) {
    entry["vertical_exponent"] = prior.shape_exponents.vertical;
  }
  if (prior.mount != Mount::kStanding) {
    entry["mount"] = kMountNames[static_cast<size_t>(prior.mount)];
  }
  if (prior.attitude != Attitude::kStanding) {
    entry["attitude"] = kAttitudeNames[static_cast<size_t>(prior.attitude)];
  }
  if (!row.aliases.empty()) entry["aliases"] = row.aliases;
  if (prior.height_m) {
    entry["height_m"] = prior.height_m->median;
    entry["height_log_sigma"] = prior.height_m->log_sigma;
  }
  constexpr EdgeBias kUnbiased = {};
  if (prior.edge_bias != kUnbiased) entry["edge_bias"] = prior.edge_bias;
  return entry;
}

}  // namespace

SemanticRows ReadSemanticRows(const std::filesystem::path& path) {
  const json document = ParseJsonFile(path);
  // Tables written by people have no header.
  if (document.is_object() && document.contains("artefact")) {
    CheckArtefactHeader(document.at("artefact"), kSemanticTableKind, path.string());
  }
  ValidateAgainstSchema(document, kSemanticTableKind, path.string());
  SemanticRows rows;
  rows.description = document.value("description", "");
  if (document.contains("default")) {
    rows.default_row = Row("default", document.at("default"), path.string() + ": default");
  }
  for (const auto& item : document.at("labels").items()) {
    rows.rows.push_back(
        Row(item.key(), item.value(), fmt::format("{}: labels/{}", path.string(), item.key())));
  }
  return rows;
}

SemanticTable ReadSemanticTable(const std::filesystem::path& path) {
  const SemanticRows rows = ReadSemanticRows(path);
  try {
    return LookUpTable(rows);
  } catch (const InputError& error) {
    throw InputError(path.string() + ": " + error.what());
  }
}

void WriteSemanticRows(const std::filesystem::path& path, const SemanticRows& rows,
                       const ArtefactInfo& info) {
  json body = {{"description", rows.description}, {"labels", json::object()}};
  if (rows.default_row) body["default"] = Entry(*rows.default_row);
  for (const SemanticRow& row : rows.rows) body["labels"][row.label] = Entry(row);
  WriteArtefact(path, kSemanticTableKind, info, body);
}

}  // namespace soslam

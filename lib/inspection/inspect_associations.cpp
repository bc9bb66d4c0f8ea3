// SPDX-License-Identifier: BSD-3-Clause
// Associations: rows are the objects that were found.
#include <fmt/format.h>

#include "artefact/json_file.h"
#include "inspection/kinds.h"

namespace soslam {
namespace {

using nlohmann::json;

// Number of rows for each value of a field.
std::string FrequenciesInWords(const json& rows, const char* field) {
  std::map<std::string, int> counts;
  for (const json& row : rows) ++counts[row.at(field)];
  return fmt::format("{}: {}", rows.size(), CountsInWords(counts));
}

std::string AgreementInWords(const json& agreement) {
  const auto share = [&](const char* name) {
    const json& value = agreement.at(name);
    return value.is_null() ? "-" : fmt::format("{:.3f}", value.get<double>());
  };
  return fmt::format(
      "{} objects found, {} given, {} of them the same; precision {}, recall {}, F1 {}",
      agreement.at("objects").get<int>(), agreement.at("given_objects").get<int>(),
      agreement.at("matched").get<int>(), share("precision"), share("recall"), share("f1"));
}

}  // namespace

Inspection InspectAssociations(const std::filesystem::path& file) {
  return ReadArtefactAs(file, "associations", [](const json& document) {
    Inspection inspection;
    inspection.facts = {{"agreement", AgreementInWords(document.at("agreement"))},
                        {"detections", FrequenciesInWords(document.at("detections"), "decision")},
                        {"tracks", FrequenciesInWords(document.at("tracks"), "fate")}};
    inspection.table.columns = {{"object", ""},     {"label", ""},        {"track", ""},
                                {"detections", ""}, {"given_object", ""}, {"label_votes", ""}};
    for (const json& object : document.at("objects")) {
      inspection.table.rows.push_back(
          {object.at("object"), object.at("label"), object.at("track"), object.at("detections"),
           object.at("given_object"),
           CountsInWords(object.at("label_votes").get<std::map<std::string, int>>())});
    }
    return inspection;
  });
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
// Estimated planes: rows are planes.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "artefact/json_file.h"
#include "artefact/model_json.h"
#include "inspection/kinds.h"

namespace soslam {
namespace {

using nlohmann::json;

// "1 sofa, 3 armchair (lowest_cost)"; without a reason if the plane follows from an object's own
// views.
std::string ObjectsOn(const json& plane, const json& objects) {
  std::vector<std::string> words;
  for (const json& object : objects) {
    if (object.at("plane") != plane.at("plane")) continue;
    const std::string reason = object.at("reason");
    words.push_back(fmt::format("{} {}", object.at("object").get<int>(),
                                object.at("label").get<std::string>()));
    if (reason != "own_height") words.back() += " (" + reason + ")";
  }
  return words.empty() ? "none" : fmt::format("{}", fmt::join(words, ", "));
}

std::vector<Value> PlaneRow(const json& fields, const json& objects) {
  const Plane plane = fields.at("plane_in_world").get<Plane>();
  const json error = fields.at("error").is_null() ? json::object() : fields.at("error");
  return {fields.at("plane"),
          plane.normal.x(),
          plane.normal.y(),
          plane.normal.z(),
          plane.offset,
          fields.at("tilt_sigma_deg"),
          fields.at("height_sigma_m"),
          error.value("angle_deg", json()),
          error.value("offset_m", json()),
          ObjectsOn(fields, objects)};
}

}  // namespace

Inspection InspectPlanes(const std::filesystem::path& file) {
  return ReadArtefactAs(file, "planes", [](const json& document) {
    const json& objects = document.at("objects");
    std::map<std::string, int> reasons;
    for (const json& object : objects) ++reasons[object.at("reason")];
    Inspection inspection;
    inspection.facts = {
        {"dataset", document.at("dataset")},
        {"found",
         fmt::format("planes: {}, objects: {}; {} after {} rounds", document.at("planes").size(),
                     objects.size(), document.at("settled").get<bool>() ? "settled" : "NOT settled",
                     document.at("rounds").get<int>())},
        {"decided by", CountsInWords(reasons)}};
    if (!document.at("cost").is_null()) {
      inspection.facts.push_back(
          {"cost", fmt::format("{:.6g}", document.at("cost").get<double>())});
    }
    inspection.table.columns = {{"plane", ""},
                                {"normal_x", "", 4},
                                {"normal_y", "", 4},
                                {"normal_z", "", 4},
                                {"offset", "m", 3},
                                {"sigma_tilt", "deg", 2},
                                {"sigma_height", "m", 3},
                                {"tilt_error", "deg", 2},
                                {"height_error", "m", 3},
                                {"objects", ""}};
    for (const json& plane : document.at("planes")) {
      inspection.table.rows.push_back(PlaneRow(plane, objects));
    }
    return inspection;
  });
}

}  // namespace soslam

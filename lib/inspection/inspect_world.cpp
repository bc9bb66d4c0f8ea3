// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <string>
#include <vector>

#include "artefact/json_file.h"
#include "inspection/inspection.h"

namespace soslam {
namespace {

using nlohmann::json;

std::string ScaleInWords(const json& scale) {
  if (scale.is_null()) return "unknown";
  const double low = scale.at("interval_95").at(0).get<double>();
  const double high = scale.at("interval_95").at(1).get<double>();
  return fmt::format("{:.4g} m per unit, {:.4g} to {:.4g} (95 %, +- {:.0f} %), by {}",
                     scale.at("metres_per_unit").get<double>(), low, high,
                     100.0 * (std::sqrt(high / low) - 1.0),
                     fmt::join(scale.at("found_by").get<std::vector<std::string>>(), ", "));
}

}  // namespace

Inspection InspectWorld(const std::filesystem::path& file) {
  return ReadArtefactAs(file, "world", [](const json& document) {
    const json& up = document.at("up");
    Inspection inspection;
    inspection.facts = {
        {"dataset", document.at("dataset")},
        {"up", fmt::format("sigma {:.2f} deg, by {}", up.at("sigma_deg").get<double>(),
                           up.at("found_by").get<std::string>())},
        {"scale", ScaleInWords(document.at("scale"))},
        {"support planes",
         fmt::format("{} of {} horizontal planes in {} points", document.at("planes").size(),
                     document.at("planes_of_points").get<int>(),
                     document.at("points").get<int>())}};
    inspection.table.columns = {{"label", ""},     {"boxes", ""},        {"plane", ""},
                                {"height", "m"},   {"log_scale", "", 3}, {"log_sigma", "", 3},
                                {"weight", "", 2}, {"agreement", "", 2}};
    for (const json& object : document.at("objects")) {
      inspection.table.rows.push_back({object.at("label"), object.at("boxes"), object.at("plane"),
                                       object.at("height_m"), object.at("log_scale"),
                                       object.at("log_sigma"), object.at("weight"),
                                       object.at("agreement")});
    }
    return inspection;
  });
}

}  // namespace soslam

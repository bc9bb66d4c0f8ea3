// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <string>
#include <vector>

#include "artefact/files.h"
#include "artefact/json_file.h"
#include "base/text.h"
#include "inspection/inspection.h"

namespace soslam {
namespace {

using nlohmann::json;

std::string UpInWords(const json& up) {
  const char* edges = up.at("verticals").get<bool>() ? " and by vertical edges" : "";
  return fmt::format(
      "z; to {:.2f} degrees (one standard deviation), by {}", up.at("sigma_deg").get<double>(),
      up.at("found_by") == "planes"
          ? "horizontal planes of points"
          : fmt::format("the way cameras are held{}, as no support plane was found", edges));
}

// What the scale is, what it rests on, and what contradicts it.
std::vector<Fact> ScaleFacts(const json& world) {
  const auto scale = ScaleOfWorld(world);
  if (!scale) {
    return {{"scale", "unknown: nothing tells it; lengths have the unit of the input's world"}};
  }
  std::vector<Fact> facts = {
      {"scale",
       fmt::format("1 unit of the input's world is {:.4g} m, {:.4g} to {:.4g} m (95 %, "
                   "+- {:.0f} %)",
                   scale->metres_per_unit, scale->low, scale->high, HalfIntervalPercent(*scale))},
      {"scale rests on", SourcesInWords(*scale)}};
  const auto labels = world.at("scale").at("labels").get<std::vector<std::string>>();
  if (!labels.empty()) {
    facts.push_back({"labels of these", fmt::format("{}", fmt::join(labels, ", "))});
  }
  const std::string contradictions = ContradictionsInWords(*scale);
  if (!contradictions.empty()) {
    facts.push_back(
        {"scale uncertain", contradictions + "; it may be wrong by more than the interval says"});
  }
  return facts;
}

// The objects with their scales by their labels alone, which are log-normal, and percentages.
json ObjectsOf(const json& world) {
  json objects = world.at("objects");
  for (json& object : objects) {
    object["agreement"] = 100.0 * object["agreement"].get<double>();
    if (!object.at("log_scale").is_number()) continue;
    object["scale"] = std::exp(object["log_scale"].get<double>());
    object["sigma"] = 100.0 * object.at("log_sigma").get<double>();
  }
  return objects;
}

}  // namespace

Inspection InspectWorld(const json& document) {
  Inspection inspection;
  inspection.facts = {{"dataset", document.at("dataset")}, {"up", UpInWords(document.at("up"))}};
  const std::string doubt = DoubtOfUp(document);
  if (!doubt.empty()) {
    inspection.facts.push_back({"up uncertain", doubt + "; it may be wrong by more than that"});
  }
  for (const Fact& fact : ScaleFacts(document)) inspection.facts.push_back(fact);
  inspection.facts.push_back(
      {"support planes",
       fmt::format("{} with objects on them, of {} horizontal ones in {} points",
                   document.at("planes").size(), document.at("planes_of_points").get<int>(),
                   document.at("points").get<int>())});
  inspection.facts.push_back(
      {"columns",
       "one row per group of boxes that are taken for one object. plane: that it stands on, none "
       "at a free height. height: in the map. scale: metres per unit if its height is that of "
       "its label; sigma: standard deviation of that. weight: below 1 for several of one label, "
       "which may be of one model. agrees: probability that its height is right at the scale of "
       "the map; objects below 50 % do not count"});
  inspection.table = TableOf({{"label"},
                              {"boxes"},
                              {"plane"},
                              {"height", "m", 2, "height_m"},
                              {"scale", "m", 3},
                              {"sigma", "%", 0},
                              {"weight"},
                              {"agrees", "%", 0, "agreement"}},
                             ObjectsOf(document));
  return inspection;
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "artefact/files.h"
#include "artefact/json_file.h"
#include "base/text.h"
#include "evaluation/statistics.h"
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

namespace {

std::string MedianInWords(const std::vector<double>& values, const char* format) {
  const auto median = MedianOf(values);
  return median ? "median " + fmt::format(fmt::runtime(format), *median) : "none";
}

// The middle 98 % of the coordinates along an axis: single points may be far away.
std::string RangeInWords(const std::vector<MapPoint>& points, int axis) {
  std::vector<double> values =
      ValuesOf(points, [&](const MapPoint& point) { return point.position_in_world[axis]; });
  std::ranges::sort(values);
  const size_t margin = values.size() / 100;
  return fmt::format("{:.3f} to {:.3f}", values[margin], values[values.size() - 1 - margin]);
}

}  // namespace

Inspection InspectPoints(const std::filesystem::path& file) {
  const std::vector<MapPoint> points = ReadPoints(file);
  std::map<int, std::vector<double>> errors_of_frame;
  size_t observations = 0;
  for (const MapPoint& point : points) {
    observations += point.observations.size();
    for (const PointObservation& observation : point.observations) {
      errors_of_frame[observation.frame_id].push_back(point.reprojection_error_px);
    }
  }
  const auto errors = ValuesOf(points, &MapPoint::reprojection_error_px);
  const auto views = ValuesOf(
      points, [](const MapPoint& point) { return static_cast<double>(point.observations.size()); });
  Inspection inspection;
  inspection.facts = {{"points", fmt::format("{}, {} observations in {} frames", points.size(),
                                             observations, errors_of_frame.size())},
                      {"reprojection error", MedianInWords(errors, "{:.2f} px")},
                      {"views of a point", MedianInWords(views, "{:.0f}")}};
  if (!points.empty()) {
    inspection.facts.push_back(
        {"98 % lie within", fmt::format("x {}, y {}, z {} m", RangeInWords(points, 0),
                                        RangeInWords(points, 1), RangeInWords(points, 2))});
  }
  inspection.table.columns = {{"frame"}, {"points"}, {"median_error", "px", 2}};
  for (const auto& [frame, of_frame] : errors_of_frame) {
    inspection.table.rows.push_back({frame, of_frame.size(), *MedianOf(of_frame)});
  }
  return inspection;
}

Inspection InspectReconstruction(const std::filesystem::path& file) {
  const ReconstructionSummary summary = ReadReconstruction(file);
  const auto in_words = [](const std::optional<double>& value, const char* unit) {
    return value ? fmt::format("{:.2f} {}", *value, unit) : "unknown";
  };
  constexpr size_t kMaxNames = 20;
  const auto source = [](bool is_given) { return is_given ? "given" : "estimated"; };
  Inspection inspection;
  inspection.facts = {
      {"COLMAP", summary.colmap.empty() ? "ran before; its model was given" : summary.colmap},
      {"registered", fmt::format("{} of {} images", summary.registered, summary.images)},
      {"poses, camera",
       fmt::format("{}, {}", source(summary.poses_are_given), source(summary.camera_is_given))},
      {"points", fmt::format("{}, {} observations", summary.points, summary.observations)},
      {"medians", fmt::format("reprojection error {}, triangulation angle {}",
                              in_words(summary.median_reprojection_error_px, "px"),
                              in_words(summary.median_triangulation_angle_deg, "degrees"))}};
  if (!summary.images_without_pose.empty()) {
    inspection.facts.push_back({"no pose", NamesInWords(summary.images_without_pose, kMaxNames)});
  }
  inspection.table.columns = {{"component"}, {"images"}, {"points"}};
  for (size_t i = 0; i < summary.components.size(); ++i) {
    inspection.table.rows.push_back(
        {i + 1, summary.components[i].images, summary.components[i].points});
  }
  return inspection;
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "artefact/files.h"
#include "base/text.h"
#include "evaluation/result_checks.h"
#include "evaluation/statistics.h"
#include "ground/ground_checks.h"
#include "inspection/inspection.h"

namespace soslam {
namespace {

std::string UpInWords(const WorldReport::Up& up) {
  const char* edges = up.verticals ? " and by vertical edges" : "";
  return fmt::format(
      "z; to {:.2f} degrees (one standard deviation), by {}", up.sigma_deg,
      up.found_by == "planes"
          ? "horizontal planes of points"
          : fmt::format("the way cameras are held{}, as no support plane was found", edges));
}

// What the scale is, what it rests on, and what contradicts it.
std::vector<Fact> ScaleFacts(const std::optional<WorldScale>& scale) {
  if (!scale) {
    return {{"scale", "unknown: nothing tells it; lengths have the unit of the input's world"}};
  }
  std::vector<Fact> facts = {
      {"scale",
       fmt::format("1 unit of the input's world is {:.4g} m, {:.4g} to {:.4g} m (95 %, "
                   "+- {:.0f} %)",
                   scale->metres_per_unit, scale->low, scale->high, HalfIntervalPercent(*scale))},
      {"scale rests on", SourcesInWords(*scale)}};
  if (!scale->labels.empty()) {
    facts.push_back({"labels of these", fmt::format("{}", fmt::join(scale->labels, ", "))});
  }
  const std::string contradictions = ContradictionsInWords(*scale);
  if (!contradictions.empty()) {
    facts.push_back(
        {"scale uncertain", contradictions + "; it may be wrong by more than the interval says"});
  }
  return facts;
}

Value ValueOf(const auto& optional) { return optional ? Value(*optional) : Value(); }

}  // namespace

Inspection InspectWorld(const std::filesystem::path& file) {
  const auto [header, findings, world] = ReadWorld(file);
  Inspection inspection;
  inspection.facts = {{"dataset", world.dataset}, {"up", UpInWords(world.up)}};
  const std::string doubt = DoubtOfUp(findings);
  if (!doubt.empty()) {
    inspection.facts.push_back({"up uncertain", doubt + "; it may be wrong by more than that"});
  }
  for (const Fact& fact : ScaleFacts(world.scale)) inspection.facts.push_back(fact);
  inspection.facts.push_back(
      {"support planes", fmt::format("{} with objects on them, of {} horizontal ones in {} points",
                                     world.planes.size(), world.planes_of_points, world.points)});
  inspection.facts.push_back(
      {"columns",
       "one row per group of boxes that are taken for one object. plane: that it stands on, none "
       "at a free height. height: in the map. scale: metres per unit if its height is that of "
       "its label; sigma: standard deviation of that. weight: below 1 for several of one label, "
       "which may be of one model. agrees: probability that its height is right at the scale of "
       "the map; objects below 50 % do not count"});
  inspection.table.columns = {{"label"},         {"boxes"},         {"plane"},  {"height", "m"},
                              {"scale", "m", 3}, {"sigma", "%", 0}, {"weight"}, {"agrees", "%", 0}};
  for (const WorldReport::ObjectRow& object : world.objects) {
    inspection.table.rows.push_back(
        {object.label, object.boxes, ValueOf(object.plane), ValueOf(object.height_m),
         object.log_scale ? Value(std::exp(*object.log_scale)) : Value(),
         object.log_sigma ? Value(100.0 * *object.log_sigma) : Value(), object.weight,
         100.0 * object.agreement});
  }
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
  const ReconstructionSummary summary = ReadReconstruction(file).body;
  const auto in_words = [](const std::optional<double>& value, const char* unit) {
    return value ? fmt::format("{:.2f} {}", *value, unit) : "unknown";
  };
  constexpr size_t kMaxNames = 20;
  Inspection inspection;
  inspection.facts = {
      {"COLMAP", summary.colmap.empty() ? "ran before; its model was given" : summary.colmap},
      {"registered", fmt::format("{} of {} images", summary.registered, summary.images)},
      {"poses, camera", fmt::format("{}, {}", NameOf(summary.poses), NameOf(summary.camera))},
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

// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "artefact/files.h"
#include "base/text.h"
#include "evaluation/statistics.h"
#include "inspection/inspection.h"

namespace soslam {
namespace {

std::string MedianInWords(const std::vector<double>& values, const char* format) {
  const auto median = MedianOf(values);
  return median ? "median " + fmt::format(fmt::runtime(format), *median) : "none";
}

// The middle 98 % of the coordinates along an axis: single points may be far away.
std::string RangeInWords(const std::vector<MapPoint>& points, int axis) {
  std::vector<double> values;
  for (const MapPoint& point : points) values.push_back(point.position_in_world[axis]);
  std::ranges::sort(values);
  const size_t margin = values.size() / 100;
  return fmt::format("{:.3f} to {:.3f}", values[margin], values[values.size() - 1 - margin]);
}

}  // namespace

Inspection InspectPoints(const std::filesystem::path& file) {
  const std::vector<MapPoint> points = ReadPoints(file);
  std::vector<double> errors, views;
  std::map<int, std::vector<double>> errors_of_frame;
  size_t observations = 0;
  for (const MapPoint& point : points) {
    errors.push_back(point.reprojection_error_px);
    views.push_back(static_cast<double>(point.observations.size()));
    observations += point.observations.size();
    for (const PointObservation& observation : point.observations) {
      errors_of_frame[observation.frame_id].push_back(point.reprojection_error_px);
    }
  }
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

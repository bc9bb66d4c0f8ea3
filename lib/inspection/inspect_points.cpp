// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "artefact/points_file.h"
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
  inspection.table.columns = {{"frame", ""}, {"points", ""}, {"median_error", "px", 2}};
  for (const auto& [frame, of_frame] : errors_of_frame) {
    inspection.table.rows.push_back({frame, of_frame.size(), *MedianOf(of_frame)});
  }
  return inspection;
}

}  // namespace soslam

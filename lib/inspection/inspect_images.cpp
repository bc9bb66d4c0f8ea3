// SPDX-License-Identifier: BSD-3-Clause
// Results from images: rows are the frames for edges, the observations for symmetry.
#include <fmt/format.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "artefact/hdf5_artefact.h"
#include "geometry/angles.h"
#include "geometry/landmark.h"
#include "inspection/kinds.h"

namespace soslam {
namespace {

std::vector<Value> FrameRow(int frame_id, const EdgeMaps& maps) {
  const int edges = cv::countNonZero(maps.edges);
  const auto pixels = static_cast<double>(maps.edges.total());
  double farthest = 0.0;
  cv::minMaxLoc(maps.distance, nullptr, &farthest);
  const bool has_edges = edges > 0;  // otherwise distances are infinite
  return {frame_id,
          maps.grey.cols,
          maps.grey.rows,
          edges,
          100.0 * edges / pixels,
          has_edges ? Value(cv::mean(maps.distance)[0]) : Value(),
          has_edges ? Value(farthest) : Value(),
          maps.corners.size()};
}

Value Degrees(double angle) { return std::isfinite(angle) ? Value(kDegPerRad * angle) : Value(); }

std::vector<Value> ObservationRow(const SymmetryRecord& record,
                                  const std::optional<Sequence>& sequence) {
  Value true_yaw, error;
  if (record.true_yaw) {
    true_yaw = Degrees(*record.true_yaw);
    error = Degrees(std::abs(YawDifferenceModuloPi(record.refined_yaw, *record.true_yaw)));
  }
  return {record.frame_id,
          record.object_id,
          LabelOf(sequence, record.object_id),
          record.samples.size(),
          Degrees(record.initial_yaw),
          Degrees(record.refined_yaw),
          record.yaw_sigma ? Degrees(*record.yaw_sigma) : Value(),
          true_yaw,
          error,
          OrNull(record.mirror_planes)};
}

std::string CurvesInWords(const std::vector<SymmetryRecord>& records) {
  std::map<std::string, int> curves;
  size_t yaws = 0;
  for (const SymmetryRecord& record : records) {
    for (const auto& [name, cost] : record.cost) ++curves[name];
    yaws = std::max(yaws, record.yaw.size());
  }
  return fmt::format("{}; up to {} yaws each", CountsInWords(curves), yaws);
}

}  // namespace

Inspection InspectEdges(const std::filesystem::path& file) {
  const EdgesReader reader(file);
  Inspection inspection;
  inspection.table.columns = {{"frame", ""},
                              {"width", "px"},
                              {"height", "px"},
                              {"edges", "px"},
                              {"edge_share", "%", 1},
                              {"mean_distance", "px", 1},
                              {"largest_distance", "px", 1},
                              {"corners", ""}};
  const std::vector<int> frames = reader.FrameIds();
  for (const int frame_id : frames) {
    inspection.table.rows.push_back(FrameRow(frame_id, reader.Read(frame_id)));
  }
  inspection.facts = {{"frames", fmt::format("{}", frames.size())}};
  return inspection;
}

Inspection InspectSymmetry(const std::filesystem::path& file,
                           const std::optional<Sequence>& sequence) {
  const std::vector<SymmetryRecord> records = ReadSymmetry(file);
  Inspection inspection;
  inspection.facts = {{"observations", fmt::format("{}", records.size())},
                      {"curves", CurvesInWords(records)}};
  inspection.table.columns = {{"frame", ""},
                              {"object", ""},
                              {"label", ""},
                              {"pairs", ""},
                              {"initial_yaw", "deg", 1},
                              {"refined_yaw", "deg", 1},
                              {"sigma_yaw", "deg", 1},
                              {"true_yaw", "deg", 1},
                              {"yaw_error", "deg", 1},
                              {"mirror_planes", ""}};
  for (const SymmetryRecord& record : records) {
    inspection.table.rows.push_back(ObservationRow(record, sequence));
  }
  return inspection;
}

}  // namespace soslam

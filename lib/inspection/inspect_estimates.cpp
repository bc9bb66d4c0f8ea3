// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>

#include "artefact/hdf5_artefact.h"
#include "artefact/json_file.h"
#include "base/text.h"
#include "geometry/angles.h"
#include "geometry/landmark.h"
#include "inspection/inspection.h"
#include "model/describe_estimates.h"
#include "model/estimates.h"

// Landmarks and maps: rows are observations, then objects.

namespace soslam {
namespace {

using nlohmann::json;

std::vector<ValueColumn> EstimateColumns() {
  return {{"frame"},
          {"object"},
          {"label"},
          {"views"},
          {"x", "m", 3},
          {"y", "m", 3},
          {"z", "m", 3},
          {"a", "m", 3},
          {"b", "m", 3},
          {"c", "m", 3},
          {"p"},
          {"p_vertical"},
          {"yaw", "deg", 1},
          {"rests_on"},
          {"sigma_centre", "m", 3},
          {"sigma_yaw", "deg", 2},
          {"quarter_turn", "", 2},
          {"sigma_size", "%", 1},
          {"cost"},
          {"hypotheses"},
          {"failure"}};
}

// Centre, half axes, shape exponents, yaw about the z axis of the object's frame, and the face that
// it rests on.
json CellsOf(const Landmark& landmark) {
  const Eigen::Vector3d &centre = landmark.Centre(), &half_axes = landmark.half_axes;
  const Eigen::Quaterniond& rotation = landmark.frame_from_object.rotation;
  json cells = {{"x", centre.x()},
                {"y", centre.y()},
                {"z", centre.z()},
                {"a", half_axes.x()},
                {"b", half_axes.y()},
                {"c", half_axes.z()},
                {"p", landmark.shape_exponents.horizontal},
                {"yaw", kDegPerRad * Yaw(rotation * Eigen::Vector3d::UnitZ(), rotation)},
                {"rests_on", kRestingFaceNames[static_cast<size_t>(landmark.rests_on)]}};
  if (landmark.shape_exponents.HasAxis()) {
    cells["p_vertical"] = landmark.shape_exponents.vertical;
  }
  return cells;
}

// Standard deviations: of the centre over all directions, of the yaw, and the root mean square over
// the three half axes.
json SigmasOf(const Covariance9& covariance, const Landmark& landmark) {
  const Eigen::Vector3d up = landmark.frame_from_object.rotation * Eigen::Vector3d::UnitZ();
  const double yaw_variance = up.dot(covariance.topLeftCorner<3, 3>() * up);
  const double centre_variance = covariance.block<3, 3>(3, 3).trace();
  const double size_variance = covariance.bottomRightCorner<3, 3>().trace() / 3.0;
  return {{"sigma_centre", std::sqrt(centre_variance)},
          {"sigma_yaw", kDegPerRad * std::sqrt(yaw_variance)},
          {"sigma_size", 100.0 * std::sqrt(size_variance)}};
}

// Sparse points that may be of an object, how many of them are expected to be, and the root mean
// square distance of these from its surface; no values without points.
json PointCells(const std::vector<PointPosterior>& points) {
  double of_object = 0.0;
  double squares = 0.0;
  for (const PointPosterior& point : points) {
    of_object += point.responsibility;
    squares += point.responsibility * point.distance * point.distance;
  }
  if (of_object <= 0.0) return json::object();
  return {{"points", points.size()},
          {"of_object", of_object},
          {"rms_distance", std::sqrt(squares / of_object)}};
}

Value FailureOf(const std::string& failure) { return failure.empty() ? Value() : Value(failure); }

// The label of an object is that of the sequence, if it is known.
json ObservationRow(const json& observation) {
  const json& hypotheses = observation.at("hypotheses");
  json row = {{"frame", observation.at("frame")},
              {"object", observation.at("object")},
              {"hypotheses", hypotheses.size()},
              {"failure", FailureOf(observation.at("failure"))}};
  if (hypotheses.empty()) return row;
  row.update(CellsOf(DescribedFromJson<Hypothesis>(hypotheses[0]).landmark_in_camera));
  row["cost"] = hypotheses[0].at("cost").get<double>();
  return row;
}

json ObjectRow(const json& fields) {
  const ObjectEstimate estimate = DescribedFromJson<ObjectEstimate>(fields);
  json row = PointCells(estimate.points);
  row["object"] = fields.at("object");
  row["views"] = estimate.observations;
  row["failure"] = FailureOf(estimate.failure);
  if (!estimate.landmark_in_world) return row;
  row.update(CellsOf(*estimate.landmark_in_world));
  if (estimate.covariance) {
    row.update(SigmasOf(*estimate.covariance, *estimate.landmark_in_world));
  }
  if (estimate.quarter_turn) row["quarter_turn"] = *estimate.quarter_turn;
  if (!estimate.proper_ellipsoid) row["failure"] = "not an ellipsoid";
  return row;
}

// Number of rows that have a landmark.
std::string FoundInWords(const json& rows, const char* name, const char* field) {
  const auto found = std::ranges::count_if(
      rows, [&](const json& row) { return !row.at(field).empty() && !row.at(field).is_null(); });
  return fmt::format("{} of {} {}", found, rows.size(), name);
}

std::vector<Fact> SolverInWords(const json& solver) {
  const auto counts = [&](const char* field) {
    return CountsInWords(solver.at(field).get<std::map<std::string, int>>());
  };
  std::vector<Fact> facts = {
      {"solver", FillIn((solver.at("converged") ? "" : "NOT ") +
                            std::string("converged after {iterations} iterations; cost "
                                        "{initial_cost:.6g} at first, {final_cost:.6g} at the end"),
                        solver)},
      {"residuals", counts("residuals")},
      {"left out", counts("gated")}};
  const auto bias = solver.value("detector_bias_px", std::array<double, 4>{});
  if (std::ranges::any_of(bias, [](double edge) { return edge != 0.0; })) {
    facts.push_back({"detector", fmt::format("edges {} of boxes have to move outwards by {:.2f} px",
                                             fmt::join(kEdgeNames, ", "), fmt::join(bias, ", "))});
  }
  return facts;
}

// Length of the path from frame to frame.
std::string TrajectoryInWords(const json& trajectory) {
  double length = 0.0;
  for (size_t i = 1; i < trajectory.size(); ++i) {
    const auto place = [&](size_t k) {
      return DescribedFromJson<Rigid3d>(trajectory[k].at("world_from_camera")).translation;
    };
    length += (place(i) - place(i - 1)).norm();
  }
  return fmt::format("{} frames, {:.2f} m", trajectory.size(), length);
}

}  // namespace

Inspection InspectLandmarks(const json& document) {
  Inspection inspection;
  const json& observations = document.at("observations");
  const json& objects = document.at("objects");
  const auto add = [&](const json& rows, const char* name, const char* field) {
    if (!rows.empty()) inspection.facts.push_back({"found", FoundInWords(rows, name, field)});
  };
  add(observations, "observations have a landmark (camera frame; the best hypothesis)",
      "hypotheses");
  add(objects, "objects have a landmark (world frame)", "landmark");
  inspection.facts.push_back(
      {"failures", CountsInWords(document.at("failures").get<std::map<std::string, int>>())});
  json rows = json::array();
  for (const json& row : observations) rows.push_back(ObservationRow(row));
  for (const json& row : objects) rows.push_back(ObjectRow(row));
  inspection.table = TableOf(EstimateColumns(), rows);
  return inspection;
}

Inspection InspectMap(const json& document) {
  Inspection inspection;
  const json& objects = document.at("objects");
  inspection.facts = {
      {"found", FoundInWords(objects, "objects have a landmark (world frame)", "landmark")},
      {"failures", CountsInWords(CountsBy("failure", objects))}};
  const std::vector<Fact> solver = SolverInWords(document.at("solver"));
  inspection.facts.insert(inspection.facts.end(), solver.begin(), solver.end());
  inspection.facts.push_back({"trajectory", TrajectoryInWords(document.at("trajectory"))});
  json rows = json::array();
  for (const json& row : objects) rows.push_back(ObjectRow(row));
  std::vector<ValueColumn> columns = EstimateColumns();
  columns.insert(columns.end(), {{"points"}, {"of_object", "", 1}, {"rms_distance", "m", 3}});
  inspection.table = TableOf(columns, rows);
  return inspection;
}

// Results from images: rows are the frames for edges, the observations for symmetry.

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

std::vector<Value> ObservationRow(const SymmetryRecord& record) {
  Value true_yaw, error;
  if (record.true_yaw) {
    true_yaw = Degrees(*record.true_yaw);
    error = Degrees(std::abs(YawDifferenceModuloPi(record.refined_yaw, *record.true_yaw)));
  }
  return {record.frame_id,
          record.object_id,
          {},
          record.samples.size(),
          Degrees(record.initial_yaw),
          Degrees(record.refined_yaw),
          record.yaw_sigma ? Degrees(*record.yaw_sigma) : Value(),
          true_yaw,
          error,
          record.mirror_planes};
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
  inspection.table.columns = {{"frame"},
                              {"width", "px"},
                              {"height", "px"},
                              {"edges", "px"},
                              {"edge_share", "%", 1},
                              {"mean_distance", "px", 1},
                              {"largest_distance", "px", 1},
                              {"corners"}};
  const std::vector<int> frames = reader.FrameIds();
  for (const int frame_id : frames) {
    inspection.table.rows.push_back(FrameRow(frame_id, reader.Read(frame_id)));
  }
  inspection.facts = {{"frames", fmt::format("{}", frames.size())}};
  return inspection;
}

Inspection InspectSymmetry(const std::filesystem::path& file) {
  const std::vector<SymmetryRecord> records = ReadSymmetry(file);
  Inspection inspection;
  inspection.facts = {{"observations", fmt::format("{}", records.size())},
                      {"curves", CurvesInWords(records)}};
  inspection.table.columns = {{"frame"},
                              {"object"},
                              {"label"},
                              {"pairs"},
                              {"initial_yaw", "deg", 1},
                              {"refined_yaw", "deg", 1},
                              {"sigma_yaw", "deg", 1},
                              {"true_yaw", "deg", 1},
                              {"yaw_error", "deg", 1},
                              {"mirror_planes"}};
  for (const SymmetryRecord& record : records) {
    inspection.table.rows.push_back(ObservationRow(record));
  }
  return inspection;
}

}  // namespace soslam

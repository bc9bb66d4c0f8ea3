// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/model_json.h"

#include <cmath>

#include "geometry/image_size.h"

namespace soslam {

using nlohmann::json;

std::vector<Finding> FindingsFromJson(const json& artefact) {
  return artefact.value("findings", std::vector<Finding>());  // since version 1.6
}

Eigen::Vector3d VectorFromJson(const json& json) {
  return Eigen::Vector3d(json.get<std::array<double, 3>>().data());
}

namespace {

// Tolerance far above the rounding of composed poses, but below the error of a number typed by
// hand.
constexpr double kUnitTolerance = 1e-6;

void RequireUnit(double norm, const char* name, const json& found) {
  if (!(std::abs(norm - 1.0) <= kUnitTolerance)) {
    throw InputError(fmt::format("{} {} has norm {}; expected 1", name, found.dump(), norm));
  }
}

}  // namespace

json VectorToJson(const Eigen::Vector3d& vector) { return {vector.x(), vector.y(), vector.z()}; }

json MatrixToJson(const Eigen::Matrix3d& matrix) {
  json rows = json::array();
  for (const auto& row : matrix.rowwise()) rows.push_back(VectorToJson(row));
  return rows;
}

Eigen::Matrix3d MatrixFromJson(const json& json) {
  Eigen::Matrix3d matrix;
  for (int i = 0; i < 3; ++i) matrix.row(i) = VectorFromJson(json.at(i));
  return matrix;
}

void to_json(json& json, const Rigid3d& rigid) {
  const Eigen::Quaterniond& q = rigid.rotation;
  json = {{"rotation_xyzw", {q.x(), q.y(), q.z(), q.w()}},
          {"translation", VectorToJson(rigid.translation)}};
}

void from_json(const json& json, Rigid3d& rigid) {
  const auto& rotation = json.at("rotation_xyzw");
  rigid.rotation = Eigen::Quaterniond(rotation.get<std::array<double, 4>>().data());
  RequireUnit(rigid.rotation.norm(), "rotation_xyzw", rotation);
  rigid.translation = VectorFromJson(json.at("translation"));
}

void to_json(json& json, const Plane& plane) {
  json = {{"normal", VectorToJson(plane.normal)}, {"offset", plane.offset}};
}

void from_json(const json& json, Plane& plane) {
  plane.normal = VectorFromJson(json.at("normal"));
  RequireUnit(plane.normal.norm(), "normal", json.at("normal"));
  plane.offset = json.at("offset").get<double>();
}

void to_json(json& json, const Box& box) { json = {box.x_min, box.y_min, box.x_max, box.y_max}; }

void from_json(const json& json, Box& box) {
  const auto edges = json.get<std::array<double, 4>>();
  box = {edges[0], edges[1], edges[2], edges[3]};
}

void to_json(json& json, const Camera& camera) {
  json = {{"width", camera.width}, {"height", camera.height}, {"fx", camera.fx},
          {"fy", camera.fy},       {"cx", camera.cx},         {"cy", camera.cy}};
}

void from_json(const json& json, Camera& camera) {
  camera = {json.at("width").get<int>(), json.at("height").get<int>(), json.at("fx").get<double>(),
            json.at("fy").get<double>(), json.at("cx").get<double>(),  json.at("cy").get<double>()};
  if (!IsImageSize(camera.width, camera.height)) {
    throw InputError(fmt::format("camera is of {} x {} pixels; expected at most {} in all",
                                 camera.width, camera.height, kMaxPixels));
  }
}

ShapeExponents ShapeExponentsFromJson(const json& json, double absent) {
  const double horizontal = json.value("shape_exponent", absent);
  return {horizontal, json.value("vertical_exponent", horizontal)};
}

json LandmarkToJson(const Landmark& landmark, const std::string& frame) {
  json fields = {{frame + "_from_object", landmark.frame_from_object},
                 {"half_axes", VectorToJson(landmark.half_axes)},
                 {"shape_exponent", landmark.shape_exponents.horizontal}};
  if (landmark.shape_exponents.HasAxis()) {
    fields["vertical_exponent"] = landmark.shape_exponents.vertical;
  }
  if (landmark.rests_on != RestingFace::kBottom) {
    fields["rests_on"] = kRestingFaceNames[static_cast<size_t>(landmark.rests_on)];
  }
  return fields;
}

Landmark LandmarkFromJson(const json& json, const std::string& frame) {
  return {json.at(frame + "_from_object").get<Rigid3d>(), VectorFromJson(json.at("half_axes")),
          ShapeExponentsFromJson(json, kEllipsoidExponent),
          EnumFromName<RestingFace>(kRestingFaceNames,
                                    json.value("rests_on", kRestingFaceNames.front()))};
}

namespace {

using CovarianceRows = std::array<std::array<double, 9>, 9>;

Covariance9 CovarianceFromJson(const json& json) {
  const auto rows = json.get<CovarianceRows>();
  return Eigen::Map<const Eigen::Matrix<double, 9, 9, Eigen::RowMajor>>(rows[0].data());
}

json PointToJson(const PointPosterior& point) {
  return {{"point", point.index},
          {"distance", point.distance},
          {"responsibility", point.responsibility}};
}

json EstimateToJson(const ObjectEstimate& estimate, const Sequence& sequence) {
  const auto& landmark = estimate.landmark_in_world;
  const auto& covariance = estimate.covariance;
  const Object& object = sequence.objects.at(estimate.object_index);
  json row = {{"object", object.id},
              {"observations", estimate.observations},
              {"landmark", landmark ? LandmarkToJson(*landmark, "world") : json()},
              {"covariance", covariance ? CovarianceToJson(*covariance) : json()},
              {"failure", estimate.failure},
              {"proper_ellipsoid", estimate.proper_ellipsoid}};
  if (!object.labels.empty()) row["labels"] = object.labels;
  if (!estimate.points.empty()) row["points"] = ListToJson(estimate.points, PointToJson);
  return row;
}

}  // namespace

json CovarianceToJson(const Covariance9& covariance) {
  json rows = json::array();
  for (const auto& row : covariance.rowwise()) {
    rows.push_back(std::vector<double>(row.begin(), row.end()));
  }
  return rows;
}

json ObjectEstimatesToJson(const std::vector<ObjectEstimate>& estimates, const Sequence& sequence) {
  return ListToJson(estimates, [&](const ObjectEstimate& estimate) {
    return EstimateToJson(estimate, sequence);
  });
}

ObjectEstimate ObjectEstimateFromJson(const json& row) {
  ObjectEstimate estimate;
  row.at("observations").get_to(estimate.observations);
  const auto& landmark = row.at("landmark");
  if (!landmark.is_null()) estimate.landmark_in_world = LandmarkFromJson(landmark, "world");
  const auto& covariance = row.at("covariance");
  if (!covariance.is_null()) estimate.covariance = CovarianceFromJson(covariance);
  row.at("failure").get_to(estimate.failure);
  row.at("proper_ellipsoid").get_to(estimate.proper_ellipsoid);
  estimate.points = ListFromJson(row, "points", [](const json& point) {
    return PointPosterior{point.at("point"), point.at("distance"), point.at("responsibility")};
  });
  return estimate;
}

std::vector<ObjectEstimate> ObjectEstimatesFromJson(const json& json, const Sequence& sequence) {
  const IdTable<Object> objects("object", sequence.objects);
  std::vector<ObjectEstimate> estimates;
  for (const auto& row : json) {
    estimates.push_back(ObjectEstimateFromJson(row));
    estimates.back().object_index = objects.IndexOf(row.at("object").get<int>());
  }
  return estimates;
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/model_json.h"

#include <cmath>

#include "geometry/image_size.h"

namespace soslam {

using nlohmann::json;

std::vector<Finding> FindingsFromJson(const json& artefact) {
  return artefact.value("findings", std::vector<Finding>());
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

void to_json(json& json, const Rigid3d& rigid) {
  const Eigen::Quaterniond& q = rigid.rotation;
  json = {{"rotation_xyzw", {q.x(), q.y(), q.z(), q.w()}}, {"translation", rigid.translation}};
}

void from_json(const json& json, Rigid3d& rigid) {
  const auto& rotation = json.at("rotation_xyzw");
  rigid.rotation = Eigen::Quaterniond(rotation.get<std::array<double, 4>>().data());
  RequireUnit(rigid.rotation.norm(), "rotation_xyzw", rotation);
  json.at("translation").get_to(rigid.translation);
}

void to_json(json& json, const Plane& plane) {
  json = {{"normal", plane.normal}, {"offset", plane.offset}};
}

void from_json(const json& json, Plane& plane) {
  json.at("normal").get_to(plane.normal);
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
                 {"half_axes", landmark.half_axes},
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
  return {json.at(frame + "_from_object").get<Rigid3d>(),
          json.at("half_axes").get<Eigen::Vector3d>(),
          ShapeExponentsFromJson(json, kEllipsoidExponent),
          EnumFromName<RestingFace>(kRestingFaceNames,
                                    json.value("rests_on", kRestingFaceNames.front()))};
}

namespace {

json EstimateToJson(const ObjectEstimate& estimate, const Sequence& sequence) {
  const auto& landmark = estimate.landmark_in_world;
  const Object& object = sequence.objects.at(estimate.object_index);
  json row = {{"object", object.id},
              {"observations", estimate.observations},
              {"landmark", landmark ? LandmarkToJson(*landmark, "world") : json()},
              {"covariance", estimate.covariance},
              {"failure", estimate.failure},
              {"proper_ellipsoid", estimate.proper_ellipsoid}};
  if (!object.labels.empty()) row["labels"] = object.labels;
  if (!estimate.points.empty()) row["points"] = estimate.points;
  if (estimate.quarter_turn) row["quarter_turn"] = *estimate.quarter_turn;
  return row;
}

}  // namespace

json ObjectEstimatesToJson(const std::vector<ObjectEstimate>& estimates, const Sequence& sequence) {
  return ListToJson(estimates, &EstimateToJson, sequence);
}

ObjectEstimate ObjectEstimateFromJson(const json& row) {
  ObjectEstimate estimate;
  row.at("observations").get_to(estimate.observations);
  const auto& landmark = row.at("landmark");
  if (!landmark.is_null()) estimate.landmark_in_world = LandmarkFromJson(landmark, "world");
  row.at("covariance").get_to(estimate.covariance);
  row.at("failure").get_to(estimate.failure);
  row.at("proper_ellipsoid").get_to(estimate.proper_ellipsoid);
  estimate.points = row.value("points", std::vector<PointPosterior>());
  if (row.contains("quarter_turn")) row["quarter_turn"].get_to(estimate.quarter_turn);
  return estimate;
}

std::vector<ObjectEstimate> ObjectEstimatesFromJson(const json& json, const Sequence& sequence) {
  std::vector<ObjectEstimate> estimates;
  for (const auto& row : json) {
    estimates.push_back(ObjectEstimateFromJson(row));
    estimates.back().object_index =
        IndexOfId("object", sequence.objects, row.at("object").get<int>());
  }
  return estimates;
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/json_geometry.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "base/error.h"
#include "geometry/image_size.h"

namespace soslam {
namespace {

using nlohmann::json;

// Tolerance far above the rounding of composed poses, but below the error of a number typed by
// hand.
constexpr double kUnitTolerance = 1e-6;

Eigen::Vector3d VectorFromJson(const json& json) {
  return Eigen::Vector3d(json.get<std::array<double, 3>>().data());
}

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
  for (int i = 0; i < 3; ++i) matrix.row(i) = VectorFromJson(json.at(static_cast<size_t>(i)));
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

json LandmarkToJson(const Landmark& landmark, const std::string& frame) {
  return {{frame + "_from_object", landmark.frame_from_object},
          {"half_axes", VectorToJson(landmark.half_axes)},
          {"shape_exponent", landmark.shape_exponent}};
}

Landmark LandmarkFromJson(const json& json, const std::string& frame) {
  return {json.at(frame + "_from_object").get<Rigid3d>(), VectorFromJson(json.at("half_axes")),
          json.value("shape_exponent", kEllipsoidExponent)};
}

}  // namespace soslam

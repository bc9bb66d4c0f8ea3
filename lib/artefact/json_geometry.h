// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <nlohmann/json.hpp>
#include <string>

#include "geometry/box.h"
#include "geometry/camera.h"
#include "geometry/landmark.h"
#include "geometry/plane.h"
#include "geometry/rigid3.h"

namespace soslam {

// Geometry in JSON, for nlohmann's `json = value` and `json.get<Value>()`. Doubles round-trip bit
// by bit. Readers assume JSON that the artefact's schema has accepted; they throw InputError,
// without the file's name, for errors that a schema cannot express.

// {"rotation_xyzw": [x, y, z, w], "translation": [x, y, z] in metres}. Reading throws InputError
// unless the quaternion has unit norm.
void to_json(nlohmann::json& json, const Rigid3d& rigid);
void from_json(const nlohmann::json& json, Rigid3d& rigid);

// {"normal": [x, y, z], "offset": metres}. Reading throws InputError unless the normal has unit
// length.
void to_json(nlohmann::json& json, const Plane& plane);
void from_json(const nlohmann::json& json, Plane& plane);

// [x_min, y_min, x_max, y_max] in pixels.
void to_json(nlohmann::json& json, const Box& box);
void from_json(const nlohmann::json& json, Box& box);

// {"width", "height", "fx", "fy", "cx", "cy"} in pixels.
void to_json(nlohmann::json& json, const Camera& camera);
void from_json(const nlohmann::json& json, Camera& camera);

// Names of the edges of a box, in the order of Box::EdgeLines.
inline constexpr std::array kEdgeNames = {"left", "top", "right", "bottom"};

nlohmann::json VectorToJson(const Eigen::Vector3d& vector);

// Matrix as rows of three numbers.
nlohmann::json MatrixToJson(const Eigen::Matrix3d& matrix);
Eigen::Matrix3d MatrixFromJson(const nlohmann::json& json);

// {"<frame>_from_object": rigid, "half_axes": [a, b, c] in metres, "shape_exponent": 1 to 2};
// `frame` is "world" or "camera". Schema version 1.0 had no shape exponent: all were ellipsoids.
nlohmann::json LandmarkToJson(const Landmark& landmark, const std::string& frame);
Landmark LandmarkFromJson(const nlohmann::json& json, const std::string& frame);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "synthesis/scene_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "artefact/json_file.h"
#include "base/error.h"
#include "geometry/angles.h"

namespace soslam {
namespace {

using nlohmann::json;

double Radians(double degrees) { return degrees * kRadPerDeg; }

Eigen::Vector2d Vector2(const json& values) {
  return {values[0].get<double>(), values[1].get<double>()};
}

Eigen::Vector3d Vector3(const json& values) {
  return {values[0].get<double>(), values[1].get<double>(), values[2].get<double>()};
}

Plane ParsePlane(const json& document, const std::string& where) {
  constexpr double kTolerance = 1e-6;  // rounding of a unit vector
  const Eigen::Vector3d normal = Vector3(document.at("normal"));
  if (!(std::abs(normal.norm() - 1.0) <= kTolerance)) {
    throw InputError(
        fmt::format("{}/normal: has length {}, expected a unit vector", where, normal.norm()));
  }
  return {normal.normalized(), document.at("d").get<double>()};
}

Camera ParseCamera(const json& document) {
  return {document.at("width").get<int>(), document.at("height").get<int>(),
          document.at("fx").get<double>(), document.at("fy").get<double>(),
          document.at("cx").get<double>(), document.at("cy").get<double>()};
}

TableTop ParseTable(const json& document) {
  TableTop table;
  table.position_on_plane = Vector2(document.at("position"));
  table.half_size = Vector2(document.at("half_size"));
  table.yaw = Radians(document.value("yaw_deg", 0.0));
  table.thickness = document.value("thickness", table.thickness);
  table.leg_length = document.value("leg_length", table.leg_length);
  return table;
}

// Throws when two of the array's entries have the same id.
void CheckUniqueIds(const json& entries, const std::string& where) {
  std::map<int, size_t> first;
  for (size_t i = 0; i < entries.size(); ++i) {
    const int id = entries[i].at("id").get<int>();
    const auto [found, is_new] = first.emplace(id, i);
    if (!is_new) {
      throw InputError(
          fmt::format("{}/{}/id: {} is already the id of entry {}", where, i, id, found->second));
    }
  }
}

std::vector<ScenePlane> ParsePlanes(const json& entries, const std::string& where) {
  CheckUniqueIds(entries, where);
  std::vector<ScenePlane> planes;
  for (size_t i = 0; i < entries.size(); ++i) {
    const json& entry = entries[i];
    ScenePlane plane;
    plane.id = entry.at("id").get<int>();
    plane.label = entry.at("label").get<std::string>();
    plane.plane_in_world = ParsePlane(entry, fmt::format("{}/{}", where, i));
    if (entry.contains("table")) plane.table = ParseTable(entry.at("table"));
    planes.push_back(plane);
  }
  std::sort(planes.begin(), planes.end(),
            [](const ScenePlane& a, const ScenePlane& b) { return a.id < b.id; });
  return planes;
}

Shape ParseShape(const std::string& name) {
  if (name == "box") return Shape::kBox;
  return name == "ellipsoid" ? Shape::kEllipsoid : Shape::kCylinder;
}

std::vector<SceneObject> ParseObjects(const json& entries, const std::vector<ScenePlane>& planes,
                                      const std::string& where) {
  CheckUniqueIds(entries, where);
  std::vector<SceneObject> objects;
  for (size_t i = 0; i < entries.size(); ++i) {
    const json& entry = entries[i];
    SceneObject object;
    object.id = entry.at("id").get<int>();
    object.label = entry.at("label").get<std::string>();
    object.shape = ParseShape(entry.at("shape").get<std::string>());
    object.half_axes = Vector3(entry.at("half_axes"));
    object.position_on_plane = Vector2(entry.at("position"));
    object.yaw = Radians(entry.value("yaw_deg", 0.0));
    object.texture_seed = entry.value("texture_seed", object.id);
    const int plane_id = entry.at("plane").get<int>();
    const auto plane = std::find_if(planes.begin(), planes.end(),
                                    [&](const ScenePlane& p) { return p.id == plane_id; });
    if (plane == planes.end()) {
      throw InputError(
          fmt::format("{}/{}/plane: there is no plane with id {}", where, i, plane_id));
    }
    object.plane_index = static_cast<int>(plane - planes.begin());
    objects.push_back(object);
  }
  std::sort(objects.begin(), objects.end(),
            [](const SceneObject& a, const SceneObject& b) { return a.id < b.id; });
  return objects;
}

Trajectory ParseTrajectory(const json& document) {
  Trajectory trajectory;
  trajectory.frames = document.at("frames").get<int>();
  trajectory.frame_interval = document.at("frame_interval").get<double>();
  for (const json& waypoint : document.at("waypoints")) {
    trajectory.waypoints.push_back(
        {Vector3(waypoint.at("position")), Vector3(waypoint.at("look_at"))});
  }
  return trajectory;
}

SceneNoise ParseNoise(const json& document) {
  SceneNoise noise;
  noise.box_edge_sigma = document.value("box_edge_sigma", 0.0);
  noise.box_sigma_px = document.value("box_sigma_px", 0.0);
  noise.miss_probability = document.value("miss_probability", 0.0);
  noise.odometry_translation_sigma = document.value("odometry_translation_sigma", 0.0);
  noise.odometry_scale_sigma = document.value("odometry_scale_sigma", 0.0);
  noise.odometry_rotation_sigma_deg = document.value("odometry_rotation_sigma_deg", 0.0);
  noise.image_sigma = document.value("image_sigma", 0.0);
  return noise;
}

// Throws unless the camera at one pose has a free view.
void CheckCameraPose(const Scene& scene, const Rigid3d& world_from_camera,
                     const std::vector<Body>& bodies, const std::string& where) {
  const Eigen::Vector3d& position = world_from_camera.translation;
  for (const ScenePlane& plane : scene.planes) {
    if (!plane.table && !(plane.plane_in_world.SignedDistance(position) > 0.0)) {
      throw InputError(fmt::format("{} is behind the plane with id {}", where, plane.id));
    }
  }
  for (size_t i = 0; i < scene.walls_in_world.size(); ++i) {
    if (!(scene.walls_in_world[i].SignedDistance(position) > 0.0)) {
      throw InputError(fmt::format("{} is behind walls/{}", where, i));
    }
  }
  for (size_t i = 0; i < bodies.size(); ++i) {
    if (!Contains(bodies[i], position)) continue;
    throw InputError(i < scene.objects.size() ? fmt::format("{} is inside the object with id {}",
                                                            where, scene.objects[i].id)
                                              : where + " is inside a table");
  }
}

void CheckTrajectory(const Scene& scene, const std::string& where) {
  std::vector<Body> bodies;
  for (const SceneObject& object : scene.objects) bodies.push_back(ObjectBody(scene, object));
  const std::vector<Body> furniture = Furniture(scene);
  bodies.insert(bodies.end(), furniture.begin(), furniture.end());
  const std::vector<Rigid3d> poses = TruePoses(scene);
  for (size_t i = 0; i < poses.size(); ++i) {
    CheckCameraPose(scene, poses[i], bodies,
                    fmt::format("{}: trajectory: the camera in frame {}", where, i));
  }
}

}  // namespace

Scene ParseScene(const json& document, const std::string& where) {
  ValidateAgainstSchema(document, "scene", where);
  Scene scene;
  scene.name = document.at("name").get<std::string>();
  scene.camera = ParseCamera(document.at("camera"));
  scene.planes = ParsePlanes(document.at("planes"), where + ": planes");
  const json walls = document.value("walls", json::array());
  for (size_t i = 0; i < walls.size(); ++i) {
    scene.walls_in_world.push_back(ParsePlane(walls[i], fmt::format("{}: walls/{}", where, i)));
  }
  scene.objects = ParseObjects(document.at("objects"), scene.planes, where + ": objects");
  scene.trajectory = ParseTrajectory(document.at("trajectory"));
  scene.noise = ParseNoise(document.value("noise", json::object()));
  scene.seed = document.value("seed", 0);
  CheckTrajectory(scene, where);
  return scene;
}

Scene ReadScene(const std::filesystem::path& path) {
  return ParseScene(ParseJsonFile(path), path.string());
}

}  // namespace soslam

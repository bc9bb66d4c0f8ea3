// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/synthesis/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "soslam/artefact/json_file.h"
#include "soslam/base/error.h"

namespace soslam {

namespace {

constexpr double kLegHalfWidth = 0.025;  // metres

// The uniform Catmull-Rom spline through four points, from p1 at 0 to p2 at 1.
Eigen::Vector3d CatmullRom(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1,
                           const Eigen::Vector3d& p2, const Eigen::Vector3d& p3, double t) {
  return 0.5 * (2.0 * p1 + (p2 - p0) * t + (2.0 * p0 - 5.0 * p1 + 4.0 * p2 - p3) * t * t +
                (3.0 * p1 - p0 - 3.0 * p2 + p3) * t * t * t);
}

// The camera on the curve through the waypoints; `parameter` is in units of waypoints.
Waypoint Interpolate(const std::vector<Waypoint>& waypoints, double parameter) {
  const int last = static_cast<int>(waypoints.size()) - 1;
  const int segment = std::clamp(static_cast<int>(parameter), 0, std::max(last - 1, 0));
  const double t = parameter - segment;
  // The curve continues straight beyond its ends.
  const auto point = [&](Eigen::Vector3d Waypoint::*member, int index) -> Eigen::Vector3d {
    if (last == 0) return waypoints[0].*member;
    if (index < 0) return 2.0 * waypoints[0].*member - waypoints[1].*member;
    if (index > last) return 2.0 * waypoints[last].*member - waypoints[last - 1].*member;
    return waypoints[index].*member;
  };
  const auto on_curve = [&](Eigen::Vector3d Waypoint::*member) {
    return CatmullRom(point(member, segment - 1), point(member, segment),
                      point(member, segment + 1), point(member, segment + 2), t);
  };
  return {on_curve(&Waypoint::position_in_world), on_curve(&Waypoint::look_at_in_world)};
}

// How far a solid reaches from its centre in a unit direction along its own axes.
double Reach(Shape shape, const Eigen::Vector3d& half_axes, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d along = half_axes.cwiseProduct(direction).cwiseAbs();
  switch (shape) {
    case Shape::kBox:
      return along.sum();
    case Shape::kEllipsoid:
      return along.norm();
    case Shape::kCylinder:
      return along.head<2>().norm() + along.z();
  }
  return 0.0;
}

}  // namespace

Scene SceneAt(Scene scene, int frame_index) {
  std::erase_if(scene.objects, [&](const SceneObject& object) {
    return frame_index < object.from_frame ||
           (object.until_frame && frame_index >= *object.until_frame);
  });
  return scene;
}

Rigid3d WorldFromPlane(const Plane& plane_in_world) {
  return {UprightRotation(plane_in_world.normal, 0.0),
          -plane_in_world.offset * plane_in_world.normal};
}

Landmark ObjectLandmark(const Scene& scene, const SceneObject& object) {
  const Plane& plane_in_world = scene.planes.at(object.plane_index).plane_in_world;
  Landmark landmark;
  landmark.half_axes = HalfAxesOnFace(object.half_axes, object.rests_on);
  landmark.rests_on = object.rests_on;
  landmark.frame_from_object.rotation = UprightRotation(plane_in_world.normal, object.yaw);
  double height = landmark.half_axes.z();
  if (!object.tilt.isZero()) {
    const Eigen::Quaterniond tilt = ExpRotation({object.tilt.x(), object.tilt.y(), 0.0});
    landmark.frame_from_object.rotation = landmark.frame_from_object.rotation * tilt;
    const Eigen::Vector3d up_in_object = tilt.conjugate() * Eigen::Vector3d::UnitZ();
    height = Reach(object.shape, object.half_axes, OwnFromObject(object.rests_on) * up_in_object);
  }
  landmark.frame_from_object.translation =
      WorldFromPlane(plane_in_world) *
      Eigen::Vector3d(object.position_on_plane.x(), object.position_on_plane.y(), height);
  return landmark;
}

Landmark ObjectBody(const Scene& scene, const SceneObject& object) {
  Landmark body = InOwnAxes(ObjectLandmark(scene, object));
  body.shape_exponents = ExponentsOf(object.shape);
  return body;
}

std::vector<Landmark> AllBodies(const Scene& scene) {
  std::vector<Landmark> bodies;
  for (const SceneObject& object : scene.objects) bodies.push_back(ObjectBody(scene, object));
  for (const ScenePlane& plane : scene.planes) {
    if (!plane.table) continue;
    const TableTop& table = *plane.table;
    const Rigid3d plane_from_table = {
        Eigen::Quaterniond(Eigen::AngleAxisd(table.yaw, Eigen::Vector3d::UnitZ())),
        {table.position_on_plane.x(), table.position_on_plane.y(), 0.0}};
    const Rigid3d world_from_table = WorldFromPlane(plane.plane_in_world) * plane_from_table;
    const auto add_box = [&](const Eigen::Vector3d& centre, const Eigen::Vector3d& half_axes) {
      bodies.push_back(
          {{world_from_table.rotation, world_from_table * centre}, half_axes, kCuboidExponent});
    };
    add_box({0.0, 0.0, -0.5 * table.thickness},
            {table.half_size.x(), table.half_size.y(), 0.5 * table.thickness});
    if (table.leg_length <= 0.0) continue;
    const Eigen::Vector2d inset = (table.half_size.array() - 2.0 * kLegHalfWidth).max(0.0).matrix();
    for (int leg = 0; leg < 4; ++leg) {
      add_box({(leg & 1 ? 1 : -1) * inset.x(), (leg & 2 ? 1 : -1) * inset.y(),
               -table.thickness - 0.5 * table.leg_length},
              {kLegHalfWidth, kLegHalfWidth, 0.5 * table.leg_length});
    }
  }
  return bodies;
}

std::vector<Rigid3d> TruePoses(const Scene& scene) {
  constexpr double kMinSine = 1e-6;
  const Trajectory& trajectory = scene.trajectory;
  const Eigen::Vector3d up = scene.planes.at(0).plane_in_world.normal;
  const double segments = static_cast<double>(trajectory.waypoints.size()) - 1.0;
  std::vector<Rigid3d> poses;
  for (int i = 0; i < trajectory.frames; ++i) {
    const double fraction = trajectory.frames > 1 ? i / (trajectory.frames - 1.0) : 0.0;
    const auto& [position, look_at] = Interpolate(trajectory.waypoints, fraction * segments);
    const Eigen::Vector3d forward = look_at - position;
    const Eigen::Vector3d right = forward.cross(up);
    if (!(right.norm() > kMinSine * forward.norm())) {
      throw InputError(
          fmt::format("scene {}: trajectory: the camera in frame {} looks straight up "
                      "or down, or at its own position",
                      scene.name, i));
    }
    Eigen::Matrix3d axes;  // without roll: the x axis is horizontal
    axes.col(2) = forward.normalized();
    axes.col(0) = right.normalized();
    axes.col(1) = axes.col(2).cross(axes.col(0));
    poses.push_back({Eigen::Quaterniond(axes).normalized(), position});
  }
  return poses;
}

namespace {

// Throws when two of the list's entries have the same id.
template <typename Entries>
void CheckUniqueIds(const Entries& entries, const std::string& where) {
  std::map<int, size_t> first;
  for (size_t i = 0; i < entries.size(); ++i) {
    const auto [found, is_new] = first.emplace(entries[i].id, i);
    if (!is_new) {
      throw InputError(fmt::format("{}/{}/id: {} is already the id of entry {}", where, i,
                                   entries[i].id, found->second));
    }
  }
}

// Throws unless the camera has a free view in all frames.
void CheckTrajectory(const Scene& scene, const std::string& where) {
  const std::vector<Landmark> bodies = AllBodies(scene);
  const std::vector<Rigid3d> poses = TruePoses(scene);
  for (size_t frame = 0; frame < poses.size(); ++frame) {
    const Eigen::Vector3d& position = poses[frame].translation;
    const std::string camera = fmt::format("{}: trajectory: the camera in frame {}", where, frame);
    for (const ScenePlane& plane : scene.planes) {
      if (!plane.table && !(plane.plane_in_world.SignedDistance(position) > 0.0)) {
        throw InputError(fmt::format("{} is behind the plane with id {}", camera, plane.id));
      }
    }
    for (size_t i = 0; i < scene.walls_in_world.size(); ++i) {
      if (!(scene.walls_in_world[i].SignedDistance(position) > 0.0)) {
        throw InputError(fmt::format("{} is behind walls/{}", camera, i));
      }
    }
    for (size_t i = 0; i < bodies.size(); ++i) {
      if (!Contains(bodies[i], position)) continue;
      throw InputError(i < scene.objects.size() ? fmt::format("{} is inside the object with id {}",
                                                              camera, scene.objects[i].id)
                                                : camera + " is inside a table");
    }
  }
}

}  // namespace

Scene ParseScene(const nlohmann::json& document, const std::string& where) {
  constexpr int kMaxImagePx = 10'000;
  auto scene = ReadDocument<Scene>(document, where);
  if (std::max(scene.camera.width, scene.camera.height) > kMaxImagePx) {
    throw InputError(fmt::format("{}: /camera is of {} x {} pixels; expected at most {} each",
                                 where, scene.camera.width, scene.camera.height, kMaxImagePx));
  }
  CheckUniqueIds(scene.planes, where + ": planes");
  CheckUniqueIds(scene.objects, where + ": objects");
  std::ranges::sort(scene.planes, {}, &ScenePlane::id);
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    int& plane_index = scene.objects[i].plane_index;  // its id until here
    const auto plane = std::ranges::find(scene.planes, plane_index, &ScenePlane::id);
    if (plane == scene.planes.end()) {
      throw InputError(
          fmt::format("{}: objects/{}/plane: there is no plane with id {}", where, i, plane_index));
    }
    plane_index = static_cast<int>(plane - scene.planes.begin());
  }
  std::ranges::sort(scene.objects, {}, &SceneObject::id);
  CheckTrajectory(scene, where);
  return scene;
}

Scene ReadScene(const std::filesystem::path& path) {
  return ParseScene(ParseJsonFile(path), path.string());
}

}  // namespace soslam

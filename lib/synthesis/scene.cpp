// SPDX-License-Identifier: BSD-3-Clause
#include "synthesis/scene.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"

namespace soslam {
namespace {

constexpr double kLegHalfWidth = 0.025;  // metres

Eigen::Quaterniond RotationAboutZ(double yaw) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
}

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

// A camera without roll: its x axis is horizontal. None if that does not determine the pose.
std::optional<Rigid3d> LookingPose(const Waypoint& waypoint, const Eigen::Vector3d& up) {
  constexpr double kMinSine = 1e-6;
  const Eigen::Vector3d forward = waypoint.look_at_in_world - waypoint.position_in_world;
  const Eigen::Vector3d right = forward.cross(up);
  if (!(right.norm() > kMinSine * forward.norm())) return std::nullopt;
  Eigen::Matrix3d axes;
  axes.col(2) = forward.normalized();
  axes.col(0) = right.normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return Rigid3d{Eigen::Quaterniond(axes).normalized(), waypoint.position_in_world};
}

}  // namespace

Rigid3d WorldFromPlane(const Plane& plane_in_world) {
  return {UprightRotation(plane_in_world.normal, 0.0),
          -plane_in_world.offset * plane_in_world.normal};
}

Body ObjectBody(const Scene& scene, const SceneObject& object) {
  const Plane& plane_in_world = scene.planes.at(object.plane_index).plane_in_world;
  const Eigen::Vector3d centre_in_plane(object.position_on_plane.x(), object.position_on_plane.y(),
                                        object.half_axes.z());
  return {object.shape,
          {{UprightRotation(plane_in_world.normal, object.yaw),
            WorldFromPlane(plane_in_world) * centre_in_plane},
           object.half_axes}};
}

std::vector<Body> Furniture(const Scene& scene) {
  std::vector<Body> bodies;
  for (const ScenePlane& plane : scene.planes) {
    if (!plane.table) continue;
    const TableTop& table = *plane.table;
    const Rigid3d plane_from_table = {
        RotationAboutZ(table.yaw), {table.position_on_plane.x(), table.position_on_plane.y(), 0.0}};
    const Rigid3d world_from_table = WorldFromPlane(plane.plane_in_world) * plane_from_table;
    const auto add_box = [&](const Eigen::Vector3d& centre, const Eigen::Vector3d& half_axes) {
      bodies.push_back(
          {Shape::kBox, {{world_from_table.rotation, world_from_table * centre}, half_axes}});
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
  const Trajectory& trajectory = scene.trajectory;
  const Eigen::Vector3d up = scene.planes.at(0).plane_in_world.normal;
  const double segments = static_cast<double>(trajectory.waypoints.size()) - 1.0;
  std::vector<Rigid3d> poses;
  for (int i = 0; i < trajectory.frames; ++i) {
    const double fraction = trajectory.frames > 1 ? i / (trajectory.frames - 1.0) : 0.0;
    const auto pose = LookingPose(Interpolate(trajectory.waypoints, fraction * segments), up);
    if (!pose) {
      throw InputError(
          fmt::format("scene {}: trajectory: the camera in frame {} looks straight up "
                      "or down, or at its own position",
                      scene.name, i));
    }
    poses.push_back(*pose);
  }
  return poses;
}

}  // namespace soslam

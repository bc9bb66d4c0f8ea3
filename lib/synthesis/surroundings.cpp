// SPDX-License-Identifier: BSD-3-Clause
#include "synthesis/surroundings.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace soslam {
namespace {

using Colour = Eigen::Vector3d;

const Colour kFloorColour(126, 141, 151);
const Colour kTableColour(84, 118, 152);
const Colour kWallColour(176, 183, 186);
const Colour kSkirtingColour(164, 171, 174);
const Colour kHazeColour(214, 208, 202);
constexpr double kHazeDistance = 40.0;    // metres, at which 1/e of the colour is left
constexpr double kSkirtingHeight = 0.09;  // metres
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double SmoothStep(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

// A pseudo-random number in [-1, 1), the same for the same cell.
double CellNoise(int x, int y) {
  uint32_t hash = static_cast<uint32_t>(x) * 0x8da6b343u ^ static_cast<uint32_t>(y) * 0xd8163841u;
  hash = (hash ^ (hash >> 15)) * 0x2c1b3c6du;
  hash = (hash ^ (hash >> 12)) * 0x297a2d39u;
  return static_cast<double>(hash ^ (hash >> 15)) / 2147483648.0 - 1.0;
}

// Tiles of half a metre, in grey levels about 0; fades with distance, where it would alias.
double TilePattern(const Eigen::Vector3d& point_in_plane, double distance) {
  constexpr double kTile = 0.5;
  constexpr double kHalfJoint = 0.004;
  constexpr double kFadeDistance = 4.0;
  constexpr double kMaxDistance = 100.0;  // beyond it the pattern has faded
  if (distance > kMaxDistance) return 0.0;
  const Eigen::Array2d scaled = point_in_plane.head<2>().array() / kTile;
  const Eigen::Array2d cell = scaled.floor();
  const double to_joint = kTile * (0.5 - (scaled - cell - 0.5).abs().maxCoeff());
  const double joint = to_joint < kHalfJoint ? -14.0 : 0.0;
  const double tile = 4.0 * CellNoise(static_cast<int>(cell.x()), static_cast<int>(cell.y()));
  const double relative_distance = distance / kFadeDistance;
  return (tile + joint) / (1.0 + relative_distance * relative_distance);
}

// Wood grain along the plane's x axis, grey levels about 0.
double GrainPattern(const Eigen::Vector3d& point_in_plane) {
  const double x = point_in_plane.x();
  const double y = point_in_plane.y();
  return 3.0 * std::sin(70.0 * y + 4.0 * std::sin(3.0 * x + 5.0 * y)) + 2.0 * std::sin(23.0 * y);
}

// The depth at which a ray meets the front of a plane.
double PlaneDepth(const Plane& plane, const Eigen::Vector3d& origin,
                  const Eigen::Vector3d& direction) {
  const double approach = -plane.normal.dot(direction);
  return approach > 0.0 ? plane.SignedDistance(origin) / approach : kInfinity;
}

}  // namespace

Surroundings::Surroundings(const Scene& scene) : scene_(scene) {
  for (const ScenePlane& plane : scene.planes) {
    plane_from_world_.push_back(WorldFromPlane(plane.plane_in_world).Inverse());
  }
  // Light from above, a little from the side, so that the faces of a box differ.
  light_in_world_ = WorldFromPlane(scene.planes.at(0).plane_in_world).rotation *
                    Eigen::Vector3d(-0.42, -0.25, 0.87).normalized();
}

double Surroundings::Light(const Eigen::Vector3d& normal_in_world) const {
  return 0.84 + 0.16 * normal_in_world.dot(light_in_world_);
}

Colour Surroundings::TableColour(const Eigen::Vector3d& point_in_world,
                                 const Eigen::Vector3d& normal_in_world) const {
  constexpr double kTolerance = 1e-6;  // metres: rounding, far less than a table's thickness
  const double light = Light(normal_in_world);
  for (size_t i = 0; i < scene_.planes.size(); ++i) {
    const Plane& plane_in_world = scene_.planes[i].plane_in_world;
    const bool is_top = scene_.planes[i].table &&
                        normal_in_world.dot(plane_in_world.normal) > 0.5 &&
                        std::abs(plane_in_world.SignedDistance(point_in_world)) < kTolerance;
    if (!is_top) continue;
    const Eigen::Vector3d point_in_plane = plane_from_world_[i] * point_in_world;
    return light * ContactShadow(static_cast<int>(i), point_in_plane) *
           (kTableColour.array() + GrainPattern(point_in_plane)).matrix();
  }
  return light * kTableColour;
}

Colour Surroundings::BackgroundColour(const Eigen::Vector3d& origin_in_world,
                                      const Eigen::Vector3d& direction_in_world) const {
  const Eigen::Vector3d direction = direction_in_world.normalized();
  double distance = kInfinity;
  Colour colour = kHazeColour;
  for (size_t i = 0; i < scene_.planes.size(); ++i) {
    const double depth = PlaneDepth(scene_.planes[i].plane_in_world, origin_in_world, direction);
    if (scene_.planes[i].table || !(depth < distance)) continue;
    distance = depth;
    colour = FloorColour(static_cast<int>(i), origin_in_world + depth * direction, depth);
  }
  for (const Plane& wall_in_world : scene_.walls_in_world) {
    const double depth = PlaneDepth(wall_in_world, origin_in_world, direction);
    if (!(depth < distance)) continue;
    distance = depth;
    colour = WallColour(wall_in_world, origin_in_world + depth * direction);
  }
  const double clarity = std::exp(-distance / kHazeDistance);
  return clarity * colour + (1.0 - clarity) * kHazeColour;
}

Colour Surroundings::FloorColour(int plane_index, const Eigen::Vector3d& point_in_world,
                                 double distance) const {
  const Eigen::Vector3d point_in_plane = plane_from_world_[plane_index] * point_in_world;
  return ContactShadow(plane_index, point_in_plane) *
         (kFloorColour.array() + TilePattern(point_in_plane, distance)).matrix();
}

Colour Surroundings::WallColour(const Plane& wall_in_world,
                                const Eigen::Vector3d& point_in_world) const {
  const double height = scene_.planes[0].plane_in_world.SignedDistance(point_in_world);
  const double light =
      0.95 + 0.07 * wall_in_world.normal.dot(light_in_world_) + 0.03 * SmoothStep(0.0, 2.5, height);
  return light * (height < kSkirtingHeight ? kSkirtingColour : kWallColour);
}

double Surroundings::ContactShadow(int plane_index, const Eigen::Vector3d& point_in_plane) const {
  double shadow = 1.0;
  for (const SceneObject& object : scene_.objects) {
    if (object.plane_index != plane_index) continue;
    const Eigen::Vector2d from_object =
        Eigen::Rotation2Dd(-object.yaw) * (point_in_plane.head<2>() - object.position_on_plane);
    const double distance = from_object.cwiseQuotient(object.half_axes.head<2>()).norm();
    shadow *= 1.0 - 0.3 * (1.0 - SmoothStep(0.2, 1.5, distance));
  }
  return shadow;
}

}  // namespace soslam

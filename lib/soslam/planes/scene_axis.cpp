// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/planes/scene_axis.h"

#include <cmath>
#include <complex>
#include <numbers>

#include "soslam/geometry/angles.h"
#include "soslam/geometry/landmark.h"
#include "soslam/geometry/rigid3.h"

namespace soslam {
namespace {

constexpr double kQuarterTurn = 0.5 * std::numbers::pi;
constexpr double kAxisSpread = 2.0 * kRadPerDeg;   // of the edges of one direction
constexpr double kAlongNormal = 5.0 * kRadPerDeg;  // edges closer to the normal are left out
constexpr double kLeastShare = 0.3;  // of the edges, within kAxisBound spreads of the axis
constexpr double kAxisBound = 2.5;
constexpr int kMaxAxisRounds = 100;
constexpr double kAxisTolerance = 1e-12;

struct Direction {
  double yaw;  // rad, modulo a quarter turn
  double weight;
};

// Sum of the weights of the directions near a yaw, each times exp(4 i (direction - yaw)).
std::complex<double> Near(const std::vector<Direction>& directions, double yaw) {
  std::complex<double> sum = 0.0;
  for (const Direction& direction : directions) {
    const double off = std::remainder(direction.yaw - yaw, kQuarterTurn);
    if (std::abs(off) > kAxisBound * kAxisSpread) continue;
    const double weight =
        direction.weight * std::exp(-0.5 * off * off / (kAxisSpread * kAxisSpread));
    sum += weight * std::polar(1.0, 4.0 * off);
  }
  return sum;
}

}  // namespace

std::optional<Eigen::Vector3d> SceneAxis(const Eigen::Vector3d& normal_in_world,
                                         const std::vector<SegmentView>& views,
                                         double correlation_rad) {
  const Eigen::Quaterniond level = UprightRotation(normal_in_world, 0.0);
  const std::vector<double> shares = CameraWeights(PosesOf(views), correlation_rad);
  std::vector<Direction> directions;
  for (size_t i = 0; i < views.size(); ++i) {
    const SegmentView& view = views[i];
    for (const LineSegment& segment : view.segments) {
      const Eigen::Vector3d across =
          (view.world_from_camera.rotation *
           view.camera.Ray(segment.begin).cross(view.camera.Ray(segment.end)))
              .normalized();
      if (std::abs(across.dot(normal_in_world)) < std::sin(kAlongNormal)) continue;
      const Eigen::Vector3d along = level.conjugate() * normal_in_world.cross(across);
      // The direction is as uncertain as its length is small.
      directions.push_back(
          {std::atan2(along.y(), along.x()),
           shares[i] * (segment.end - segment.begin).norm() * along.squaredNorm()});
    }
  }
  if (directions.empty()) return std::nullopt;
  double best = 0.0;
  double highest = 0.0;
  for (double yaw = 0.0; yaw < kQuarterTurn; yaw += 0.5 * kAxisSpread) {
    const double density = std::abs(Near(directions, yaw));
    if (density <= highest) continue;
    highest = density;
    best = yaw;
  }
  for (int round = 0; round < kMaxAxisRounds; ++round) {
    const double step = 0.25 * std::arg(Near(directions, best));
    best += step;
    if (std::abs(step) < kAxisTolerance) break;
  }
  double near = 0.0;
  double all = 0.0;
  for (const Direction& direction : directions) {
    all += direction.weight;
    const double off = std::remainder(direction.yaw - best, kQuarterTurn);
    if (std::abs(off) <= kAxisBound * kAxisSpread) near += direction.weight;
  }
  if (near / all < kLeastShare) return std::nullopt;
  return UprightRotation(normal_in_world, best) * Eigen::Vector3d::UnitX();
}

void SetSceneAxes(const std::vector<SegmentView>& views, double correlation_rad,
                  Sequence* sequence) {
  for (SupportPlane& plane : sequence->planes) {
    if (plane.scene_axis_in_world) continue;
    plane.scene_axis_in_world = SceneAxis(plane.plane_in_world.normal, views, correlation_rad);
  }
}

}  // namespace soslam

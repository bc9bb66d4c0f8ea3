// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "soslam/constraints/surface_distance.h"
#include "soslam/geometry/rigid3.h"
#include "soslam/initialisation/object_points.h"
#include "support/random.h"

namespace soslam {

// Sparse points with the errors that PointCost assumes, of a cuboid and of what is behind it and in
// front; the errors that grow with the range are independent, or all points have the same. Each
// point is in the camera of one of the views, whose index is that of its detection.
class PointSimulator {
 public:
  PointSimulator(const Landmark& cuboid, std::vector<Rigid3d> world_from_camera,
                 const PointOptions& options, bool share_drift)
      : cuboid_(cuboid),
        world_from_camera_(std::move(world_from_camera)),
        options_(options),
        size_m_(SizeForPoints(cuboid)),
        share_drift_(share_drift) {}

  PointsOfObject Points(int count, double least_prior, double most_prior) {
    PointsOfObject points;
    for (size_t i = 0; i < world_from_camera_.size(); ++i) {
      points.push_back({static_cast<int>(i), {}});
    }
    for (int i = 0; i < count; ++i) {
      PointsInView& view = points[i % points.size()];
      view.points.push_back(PointIn(world_from_camera_[view.detection_index],
                                    RandomUniform(least_prior, most_prior)));
    }
    return points;
  }

 private:
  static constexpr double kRoughShare = 0.6;  // of the object's points, as PointCost has it

  ObjectPoint PointIn(const Rigid3d& world_from_camera, double prior) const {
    const Rigid3d camera_from_world = world_from_camera.Inverse();
    while (true) {
      const int face = FaceTowards(world_from_camera.translation);
      Eigen::Vector3d foot = cuboid_.half_axes.cwiseProduct(RandomVector(-1.0, 1.0));
      const Eigen::Vector3d normal =
          Eigen::Vector3d::Unit(face) * std::copysign(1.0, (cuboid_.frame_from_object.Inverse() *
                                                            world_from_camera.translation)[face]);
      foot[face] = cuboid_.half_axes[face] * normal[face];
      const double range =
          (cuboid_.frame_from_object * foot - world_from_camera.translation).norm();
      const double distance = Distance(prior, range);
      const Eigen::Vector3d position = cuboid_.frame_from_object * (foot + distance * normal);
      // Deep ones may be nearer to another face.
      if (std::abs(SurfaceDistance(cuboid_, position, nullptr) - distance) > 1e-9) continue;
      const double drift_m = share_drift_ ? options_.point_range_fraction * range : 0.0;
      return {camera_from_world * (position + drift_m * unit_drift_), Eigen::Matrix3d::Zero(),
              prior};
    }
  }

  // A face that this place sees, by its area.
  int FaceTowards(const Eigen::Vector3d& in_world) const {
    const Eigen::Array3d from = (cuboid_.frame_from_object.Inverse() * in_world).array().abs();
    const Eigen::Array3d& half = cuboid_.half_axes.array();
    std::array<double, 3> areas{};
    for (int i = 0; i < 3; ++i) {
      areas[i] = from[i] > half[i] ? half.prod() / half[i] : 0.0;
    }
    return std::discrete_distribution<int>(areas.begin(), areas.end())(TestRandom());
  }

  // The background has the density of one over the size: it fills as much outside as is left by
  // what is inside.
  double Distance(double prior, double range) const {
    const double of_range_m = share_drift_ ? 0.0 : options_.point_range_fraction * range;
    const double sigma = std::hypot(options_.point_sigma_fraction * size_m_, of_range_m);
    const double rough = std::hypot(options_.point_roughness_fraction * size_m_, of_range_m);
    const double bell = std::sqrt(0.5 * std::numbers::pi);  // integral of one side
    const double outlier = options_.point_outlier_probability;
    if (RandomUniform(0.0, 1.0) < prior) {
      switch (OneOf({sigma, (1.0 - kRoughShare) * sigma, kRoughShare * rough})) {
        case 0:
          return std::abs(RandomNormal(sigma));
        case 1:
          return -std::abs(RandomNormal(sigma));
        default:
          return -std::abs(RandomNormal(rough));
      }
    }
    const double near = (1.0 - outlier) * bell * sigma;
    const double deepest = 0.5 * size_m_;
    const double outside = size_m_ - near - outlier * deepest;
    switch (OneOf({outside, near, outlier * deepest})) {
      case 0:
        return RandomUniform(0.0, outside);
      case 1:
        return -std::abs(RandomNormal(sigma));
      default:
        return RandomUniform(-deepest, 0.0);
    }
  }

  static int OneOf(std::initializer_list<double> weights) {
    return std::discrete_distribution<int>(weights)(TestRandom());
  }

  const Landmark& cuboid_;
  std::vector<Rigid3d> world_from_camera_;
  const PointOptions& options_;
  double size_m_;
  bool share_drift_;
  const Eigen::Vector3d unit_drift_ = RandomNormalVector(1.0);  // in the world, per m of drift
};

}  // namespace soslam

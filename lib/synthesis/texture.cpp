// SPDX-License-Identifier: BSD-3-Clause
#include "synthesis/texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace soslam {
namespace {

constexpr int kPatches = 24;    // on the half with y >= 0
constexpr int kCandidates = 8;  // per patch; the one farthest from other patches is taken

// Blue, green, red. Pale enough for an edge detector to find the patches at usual thresholds.
const std::array<Eigen::Vector3d, 5> kBaseColours = {
    Eigen::Vector3d(205, 230, 242), Eigen::Vector3d(240, 226, 208), Eigen::Vector3d(212, 236, 216),
    Eigen::Vector3d(214, 218, 244), Eigen::Vector3d(228, 232, 234)};
const std::array<Eigen::Vector3d, 7> kPatchColours = {
    Eigen::Vector3d(118, 62, 24),  Eigen::Vector3d(48, 34, 168), Eigen::Vector3d(58, 98, 22),
    Eigen::Vector3d(28, 118, 222), Eigen::Vector3d(118, 46, 98), Eigen::Vector3d(124, 104, 0),
    Eigen::Vector3d(44, 40, 40)};

// The point where the ray from the object's centre in that direction leaves it, in the object
// frame.
Eigen::Vector3d SurfacePoint(const SceneObject& object, const Eigen::Vector3d& direction) {
  double gauge = direction.norm();
  if (object.shape == Shape::kBox) gauge = direction.cwiseAbs().maxCoeff();
  if (object.shape == Shape::kCylinder) {
    gauge = std::max(direction.head<2>().norm(), std::abs(direction.z()));
  }
  return (direction / gauge).cwiseProduct(object.half_axes);
}

// The approximate radius of a disc with the mean area of a patch.
double MeanPatchRadius(const Eigen::Vector3d& half_axes) {
  constexpr double kShareOfBoundingBox = 0.65;  // of its surface; the ellipsoid's is about half
  const double half_surface = kShareOfBoundingBox * 4.0 *
                              (half_axes.x() * half_axes.y() + half_axes.y() * half_axes.z() +
                               half_axes.z() * half_axes.x());
  return std::sqrt(half_surface / (kPatches * std::numbers::pi));
}

}  // namespace

SurfaceTexture::SurfaceTexture(const SceneObject& object) {
  std::mt19937 random(static_cast<std::mt19937::result_type>(object.texture_seed));
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> relative_radius(0.4, 0.95);
  base_colour_ = kBaseColours[random() % kBaseColours.size()];
  const double mean_radius = MeanPatchRadius(object.half_axes);

  while (patches_.size() < kPatches) {
    Eigen::Vector3d best = Eigen::Vector3d::Zero();
    double best_distance = -1.0;
    for (int i = 0; i < kCandidates; ++i) {
      const double x = normal(random), y = normal(random), z = normal(random);
      const Eigen::Vector3d candidate = SurfacePoint(object, {x, std::abs(y), z});
      double distance = std::numeric_limits<double>::infinity();
      for (const Patch& patch : patches_) {
        distance = std::min(distance, (candidate - patch.centre_in_object).norm());
      }
      if (distance > best_distance) {
        best = candidate;
        best_distance = distance;
      }
    }
    const double radius = mean_radius * relative_radius(random);
    patches_.push_back({best, radius * radius, kPatchColours[random() % kPatchColours.size()]});
  }
}

Eigen::Vector3d SurfaceTexture::Colour(const Eigen::Vector3d& point_in_object) const {
  // A point with y >= 0 in the mirror image of a ball with its centre at y >= 0 is in the ball too.
  const Eigen::Vector3d folded(point_in_object.x(), std::abs(point_in_object.y()),
                               point_in_object.z());
  for (const Patch& patch : patches_) {
    if ((folded - patch.centre_in_object).squaredNorm() <= patch.squared_radius) {
      return patch.colour;
    }
  }
  return base_colour_;
}

}  // namespace soslam

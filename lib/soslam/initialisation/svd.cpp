// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/initialisation/svd.h"

#include <Eigen/Dense>
#include <cmath>

#include "soslam/geometry/triangulation.h"

namespace soslam {
namespace {

constexpr int kCoefficients = 10;  // of a symmetric 4 x 4 matrix
constexpr int kMinPlanes = kCoefficients - 1;

}  // namespace

std::optional<DualQuadricLandmark> LandmarkFromTangentPlanes(
    const std::vector<Plane>& planes_in_world) {
  if (planes_in_world.size() < kMinPlanes) return std::nullopt;

  // Coordinates centred on the object and scaled by its size, so that all coefficients have the
  // same magnitude.
  PointOnPlanes on_planes;
  for (const Plane& plane : planes_in_world) on_planes.Add(plane);
  const Eigen::Vector3d centre = on_planes.Solve();
  double squares = 0.0;
  for (const Plane& plane : planes_in_world) {
    squares += std::pow(plane.SignedDistance(centre), 2);
  }
  const double size = std::sqrt(squares / static_cast<double>(planes_in_world.size()));
  if (!(size > 0.0)) return std::nullopt;

  Eigen::Matrix<double, Eigen::Dynamic, kCoefficients> equations(planes_in_world.size(),
                                                                 kCoefficients);
  for (size_t i = 0; i < planes_in_world.size(); ++i) {
    const Plane& plane = planes_in_world[i];
    Eigen::Vector4d scaled;
    scaled << plane.normal, plane.SignedDistance(centre) / size;
    // The product of this row with the upper triangle of Q* is pi^T Q* pi.
    auto row = equations.row(static_cast<Eigen::Index>(i));
    for (int j = 0, n = 0; j < 4; ++j) {
      for (int k = j; k < 4; ++k) row(n++) = (j == k ? 1.0 : 2.0) * scaled(j) * scaled(k);
    }
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(equations, Eigen::ComputeFullV);
  Eigen::Matrix4d dual_quadric;
  for (int j = 0, n = 0; j < 4; ++j) {
    for (int k = j; k < 4; ++k) {
      dual_quadric(j, k) = dual_quadric(k, j) = svd.matrixV()(n++, kCoefficients - 1);
    }
  }
  auto result = LandmarkFromDualQuadric(dual_quadric);
  if (!result) return std::nullopt;
  Rigid3d& world_from_object = result->landmark.frame_from_object;
  world_from_object.translation = centre + size * world_from_object.translation;
  result->landmark.half_axes *= size;
  return result;
}

}  // namespace soslam

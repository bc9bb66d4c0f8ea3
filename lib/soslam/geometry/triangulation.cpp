// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/geometry/triangulation.h"

#include <ceres/loss_function.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "soslam/base/levenberg_marquardt.h"
#include "soslam/base/quadratic_model.h"
#include "soslam/geometry/angles.h"

namespace soslam {
namespace {

// Rays within a tenth of a degree of each other meet anywhere.
constexpr double kLeastSpread = 1e-6;

// d pixel / d point in the world.
Eigen::Matrix<double, 2, 3> PixelJacobian(const PointView& view, const Eigen::Vector3d& in_camera) {
  return view.camera.ProjectionJacobian(in_camera) *
         view.camera_from_world.rotation.toRotationMatrix();
}

// Reprojection errors (px) to second order about a point, under the loss; a cost that is not finite
// behind a camera.
QuadraticModel<3> Linearise(const std::vector<PointView>& views,
                            const Eigen::Vector3d& point_in_world,
                            const ceres::LossFunction& loss) {
  QuadraticModel<3> model;
  for (const PointView& view : views) {
    const Eigen::Vector3d in_camera = view.camera_from_world * point_in_world;
    const auto pixel = view.camera.Project(in_camera);
    if (!pixel) {
      model.cost = std::numeric_limits<double>::infinity();
      return model;
    }
    const Eigen::Vector2d residual = *pixel - view.pixel;
    const Eigen::Matrix<double, 2, 3> jacobian = PixelJacobian(view, in_camera);
    double rho[3];
    loss.Evaluate(residual.squaredNorm(), rho);
    model.cost += 0.5 * rho[0];
    model.gradient += rho[1] * jacobian.transpose() * residual;
    model.information += rho[1] * jacobian.transpose() * jacobian;
  }
  return model;
}

}  // namespace

std::optional<Eigen::Vector3d> NearestPointToRays(const std::vector<Ray>& rays,
                                                  double least_spread) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const Ray& ray : rays) {
    const Eigen::Matrix3d across =
        Eigen::Matrix3d::Identity() - ray.direction * ray.direction.transpose();
    sum += across;
    right += across * ray.origin;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(sum /
                                                             static_cast<double>(rays.size()));
  if (!(eigen.eigenvalues()(0) >= least_spread)) return std::nullopt;
  return sum.ldlt().solve(right);
}

std::optional<TriangulatedPoint> Triangulate(const std::vector<PointView>& views, double huber_px) {
  if (views.size() < 2) return std::nullopt;
  std::vector<Ray> rays;
  for (const PointView& view : views) {
    const Rigid3d world_from_camera = view.camera_from_world.Inverse();
    rays.push_back({world_from_camera.translation,
                    world_from_camera.rotation * view.camera.Ray(view.pixel).normalized()});
  }
  auto point = NearestPointToRays(rays, kLeastSpread);
  if (!point) return std::nullopt;
  const ceres::HuberLoss loss(huber_px);
  const QuadraticModel<3> at = MinimiseSquares(
      [&](const Eigen::Vector3d& state) { return Linearise(views, state, loss); }, {}, &*point);
  if (!std::isfinite(at.cost)) return std::nullopt;
  double sum_px = 0.0;
  for (const PointView& view : views) sum_px += ReprojectionError(view, *point);
  const TriangulatedPoint result = {*point, PointInformation(views, *point).inverse(),
                                    sum_px / static_cast<double>(views.size())};
  return result.covariance.allFinite() ? std::optional(result) : std::nullopt;
}

double ReprojectionError(const PointView& view, const Eigen::Vector3d& point_in_world) {
  const auto pixel = view.camera.Project(view.camera_from_world * point_in_world);
  return pixel ? (*pixel - view.pixel).norm() : std::numeric_limits<double>::infinity();
}

Eigen::Matrix3d PointInformation(const std::vector<PointView>& views,
                                 const Eigen::Vector3d& point_in_world) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  for (const PointView& view : views) {
    const auto jacobian = PixelJacobian(view, view.camera_from_world * point_in_world);
    information += jacobian.transpose() * jacobian;
  }
  return information;
}

double LargestAngle(const std::vector<Eigen::Vector3d>& camera_centres,
                    const Eigen::Vector3d& point_in_world) {
  std::vector<Eigen::Vector3d> directions;
  for (const Eigen::Vector3d& centre : camera_centres) {
    directions.push_back(centre - point_in_world);
  }
  double largest = 0.0;
  for (size_t i = 0; i < directions.size(); ++i) {
    for (size_t k = 0; k < i; ++k) {
      largest = std::max(largest, AngleBetween(directions[i], directions[k]));
    }
  }
  return largest;
}

void PointOnPlanes::Add(const Plane& plane, double weight) {
  normal_matrix_ += weight * plane.normal * plane.normal.transpose();
  right_side_ -= weight * plane.offset * plane.normal;
}

Eigen::Vector3d PointOnPlanes::Solve() const {
  return normal_matrix_.completeOrthogonalDecomposition().solve(right_side_);
}

}  // namespace soslam

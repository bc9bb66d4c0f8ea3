// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/landmark.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <numbers>

namespace soslam {
namespace {

// A direction orthogonal to the normal: the projection of x, or of y where x is (nearly) the
// normal.
Eigen::Vector3d HorizontalReference(const Eigen::Vector3d& normal) {
  const Eigen::Vector3d seed =
      std::abs(normal.x()) < 0.9 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  return (seed - normal * normal.dot(seed)).normalized();
}

}  // namespace

Landmark Transform(const Rigid3d& target_from_source, const Landmark& landmark_in_source) {
  return {target_from_source * landmark_in_source.frame_from_object, landmark_in_source.half_axes};
}

Eigen::Matrix4d DualQuadric(const Landmark& landmark) {
  const Eigen::Matrix4d pose = landmark.frame_from_object.Matrix();
  Eigen::Vector4d diagonal;
  diagonal << landmark.half_axes.cwiseAbs2(), -1.0;
  return pose * diagonal.asDiagonal() * pose.transpose();
}

Eigen::Matrix4d Quadric(const Landmark& landmark) {
  const Eigen::Matrix4d inverse_pose = landmark.frame_from_object.Inverse().Matrix();
  Eigen::Vector4d diagonal;
  diagonal << landmark.half_axes.cwiseAbs2().cwiseInverse(), -1.0;
  return inverse_pose.transpose() * diagonal.asDiagonal() * inverse_pose;
}

std::optional<DualQuadricLandmark> LandmarkFromDualQuadric(const Eigen::Matrix4d& dual_quadric) {
  if (!dual_quadric.allFinite() || dual_quadric(3, 3) == 0.0) return std::nullopt;
  const Eigen::Matrix4d scaled = dual_quadric / -dual_quadric(3, 3);
  const Eigen::Vector3d centre = -scaled.topRightCorner<3, 1>();
  const Eigen::Matrix3d centred = scaled.topLeftCorner<3, 3>() + centre * centre.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(0.5 * (centred + centred.transpose()));
  if (eigen.info() != Eigen::Success) return std::nullopt;
  Eigen::Matrix3d axes = eigen.eigenvectors();
  if (axes.determinant() < 0.0) axes.col(2) = -axes.col(2);

  DualQuadricLandmark result;
  result.proper = eigen.eigenvalues().minCoeff() > 0.0;
  result.landmark.frame_from_object = {Eigen::Quaterniond(axes).normalized(), centre};
  result.landmark.half_axes = eigen.eigenvalues().cwiseAbs().cwiseSqrt();
  const bool usable = centre.allFinite() && result.landmark.half_axes.allFinite() &&
                      result.landmark.half_axes.minCoeff() > 0.0;
  return usable ? std::optional(result) : std::nullopt;
}

std::optional<Box> OutlineBox(const Camera& camera, const Landmark& landmark_in_camera) {
  const Rigid3d& camera_from_object = landmark_in_camera.frame_from_object;
  const Eigen::Matrix3d scaled_axes =
      camera_from_object.rotation.toRotationMatrix() * landmark_in_camera.half_axes.asDiagonal();
  const double depth_extent = scaled_axes.row(2).norm();
  if (!(camera_from_object.translation.z() > depth_extent)) return std::nullopt;

  const Eigen::Matrix3d conic =
      camera.Intrinsics() *
      (scaled_axes * scaled_axes.transpose() -
       camera_from_object.translation * camera_from_object.translation.transpose()) *
      camera.Intrinsics().transpose();
  // A vertical line x = u is tangent iff (1, 0, -u) C* (1, 0, -u)^T = 0; likewise for rows.
  const auto bounds = [&conic](int axis) {
    const double root =
        std::sqrt(std::max(0.0, conic(axis, 2) * conic(axis, 2) - conic(axis, axis) * conic(2, 2)));
    return std::pair((conic(axis, 2) + root) / conic(2, 2), (conic(axis, 2) - root) / conic(2, 2));
  };
  const auto [x_min, x_max] = bounds(0);
  const auto [y_min, y_max] = bounds(1);
  return Box{x_min, y_min, x_max, y_max};
}

double OutlineEdgeRms(const Camera& camera, const Landmark& landmark_in_camera, const Box& box) {
  const auto outline = OutlineBox(camera, landmark_in_camera);
  if (!outline) return std::numeric_limits<double>::infinity();
  const Eigen::Vector4d difference(outline->x_min - box.x_min, outline->y_min - box.y_min,
                                   outline->x_max - box.x_max, outline->y_max - box.y_max);
  return 0.5 * difference.norm();
}

std::optional<double> NearestIntersection(const Landmark& landmark, const Eigen::Vector3d& origin,
                                          const Eigen::Vector3d& direction) {
  // In the object frame scaled to the unit sphere the surface is |o + t d|^2 = 1.
  const Eigen::Quaterniond object_from_frame = landmark.frame_from_object.rotation.conjugate();
  const Eigen::Array3d inverse_axes = landmark.half_axes.array().inverse();
  const Eigen::Vector3d o =
      ((object_from_frame * (origin - landmark.Centre())).array() * inverse_axes).matrix();
  const Eigen::Vector3d d = ((object_from_frame * direction).array() * inverse_axes).matrix();
  const double a = d.squaredNorm();
  const double half_b = o.dot(d);
  const double c = o.squaredNorm() - 1.0;
  const double discriminant = half_b * half_b - a * c;
  // c <= 0: the origin is inside, so there is no visible outside. half_b >= 0: the ray leads away.
  if (!(discriminant >= 0.0) || !(c > 0.0) || !(half_b < 0.0)) return std::nullopt;
  return c / (-half_b + std::sqrt(discriminant));
}

Eigen::Vector3d Mirror(const Landmark& landmark, const Eigen::Vector3d& point) {
  const Eigen::Vector3d y_axis = landmark.frame_from_object.rotation * Eigen::Vector3d::UnitY();
  return point - 2.0 * y_axis.dot(point - landmark.Centre()) * y_axis;
}

Eigen::Quaterniond UprightRotation(const Eigen::Vector3d& support_normal, double yaw) {
  const Eigen::Vector3d reference = HorizontalReference(support_normal);
  Eigen::Matrix3d axes;
  axes.col(0) = reference;
  axes.col(1) = support_normal.cross(reference);
  axes.col(2) = support_normal;
  return (Eigen::Quaterniond(axes) *
          Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ())))
      .normalized();
}

double Yaw(const Eigen::Vector3d& support_normal, const Eigen::Quaterniond& frame_from_object) {
  const Eigen::Vector3d reference = HorizontalReference(support_normal);
  const Eigen::Vector3d front = frame_from_object * Eigen::Vector3d::UnitX();
  return std::atan2(front.dot(support_normal.cross(reference)), front.dot(reference));
}

Landmark Turned(const Landmark& landmark, double angle) {
  Landmark turned = landmark;
  turned.frame_from_object.rotation =
      (landmark.frame_from_object.rotation *
       Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ())))
          .normalized();
  return turned;
}

double YawDifferenceModuloPi(double yaw, double other) {
  constexpr double kPi = std::numbers::pi;
  const double difference = std::fmod(yaw - other + 0.5 * kPi, kPi);
  return (difference < 0.0 ? difference + kPi : difference) - 0.5 * kPi;
}

}  // namespace soslam

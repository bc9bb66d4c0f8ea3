// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/constraints/surface_distance.h"

#include <cmath>

#include "soslam/geometry/support_function.h"

namespace soslam {
namespace {

constexpr double kNearCentre = 1e-9;
// Stands for the infinite dual exponent of rectangular sections without flat caps: the distance
// would jump where the sections' sides meet.
constexpr double kSharpSection = 40.0;

// A point's distance from the surface, with derivatives in the object's frame.
struct Distance {
  double value;
  Eigen::Vector3d normal;
  Eigen::Vector3d d_point;
  Eigen::Vector3d d_log_half_axes;
};

Distance FaceDistance(const Eigen::Vector3d& half_axes, int axis, const Eigen::Vector3d& x) {
  const Eigen::Vector3d normal = Eigen::Vector3d::Unit(axis) * std::copysign(1.0, x[axis]);
  return {std::abs(x[axis]) - half_axes[axis], normal, normal,
          -half_axes[axis] * Eigen::Vector3d::Unit(axis)};
}

Distance Larger(const Distance& one, const Distance& other) {
  return one.value >= other.value ? one : other;
}

Distance FirstOrderDistance(const Eigen::Vector3d& half_axes, const ShapeExponents& dual,
                            const Eigen::Vector3d& x, bool with_derivatives) {
  const Eigen::Array3d inverse_axes = half_axes.array().inverse();
  const Eigen::Array3d u = x.array() * inverse_axes;
  if (!(u.abs().maxCoeff() > kNearCentre)) {
    return {-half_axes.minCoeff(), Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero(),
            Eigen::Vector3d::Zero()};
  }
  Eigen::Matrix3d hessian;  // of F by u
  const auto [norm, slopes] = SuperquadricNorm(u, dual, with_derivatives ? &hessian : nullptr);
  const Eigen::Vector3d gradient = (slopes * inverse_axes).matrix();  // dF / dx
  const double slope = gradient.norm();
  const double value = (norm - 1.0) / slope;
  if (!with_derivatives) {
    return {value, gradient / slope, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  }
  const Eigen::Vector3d d_slope =
      ((hessian * gradient.cwiseProduct(inverse_axes.matrix())).array() * inverse_axes).matrix() /
      slope;
  const Eigen::Vector3d d_point = (gradient - value * d_slope) / slope;
  return {value, gradient / slope, d_point,
          -x.cwiseProduct(d_point) + value / (slope * slope) * gradient.cwiseAbs2()};
}

Distance DistanceInObject(const Landmark& landmark, const Eigen::Vector3d& x,
                          bool with_derivatives) {
  const Eigen::Vector3d& half_axes = landmark.half_axes;
  ShapeExponents dual = DualExponents(landmark.shape_exponents);
  if (!std::isinf(dual.vertical)) {
    if (std::isinf(dual.horizontal)) dual.horizontal = kSharpSection;
    return FirstOrderDistance(half_axes, dual, x, with_derivatives);
  }
  const Distance side =
      std::isinf(dual.horizontal)
          ? Larger(FaceDistance(half_axes, 0, x), FaceDistance(half_axes, 1, x))
          : FirstOrderDistance(half_axes, dual, {x.x(), x.y(), 0.0}, with_derivatives);
  return Larger(side, FaceDistance(half_axes, 2, x));
}

}  // namespace

double SurfaceDistance(const Landmark& landmark, const Eigen::Vector3d& point,
                       LandmarkJacobian1* jacobian, Eigen::Vector3d* normal) {
  const Eigen::Matrix3d rotation = landmark.frame_from_object.rotation.toRotationMatrix();
  const Eigen::Vector3d from_centre = point - landmark.Centre();
  const Eigen::Vector3d x = rotation.transpose() * from_centre;
  const Distance distance = DistanceInObject(landmark, x, jacobian != nullptr);
  if (normal != nullptr) *normal = rotation * distance.normal;
  if (jacobian != nullptr) {
    const Eigen::Vector3d d_point = rotation * distance.d_point;
    jacobian->head<3>() = d_point.cross(from_centre);
    jacobian->segment<3>(3) = -d_point;
    jacobian->tail<3>() = distance.d_log_half_axes;
  }
  return distance.value;
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "constraints/surface_distance.h"

#include <cmath>

#include "geometry/surface.h"

namespace soslam {
namespace {

constexpr double kNearCentre = 1e-9;

// F of the point u = (x / a, y / b, z / c), with derivatives by u.
struct Norm {
  double value;
  Eigen::Array3d slopes;
  Eigen::Matrix3d hessian;
};

Norm QNorm(const Eigen::Array3d& u, double q) {
  const double largest = u.abs().maxCoeff();
  const Eigen::Array3d share = u.abs() / largest;  // at most 1: powers stay finite
  const double value = largest * std::pow(share.pow(q).sum(), 1.0 / q);
  const Eigen::Array3d relative = u.abs() / value;
  Norm norm = {value, relative.pow(q - 1.0) * u.sign(), Eigen::Matrix3d::Zero()};
  norm.hessian = -norm.slopes.matrix() * norm.slopes.matrix().transpose();
  norm.hessian.diagonal() += relative.pow(q - 2.0).matrix();
  norm.hessian *= (q - 1.0) / value;
  return norm;
}

// In the object's frame.
struct Distance {
  double value;
  Eigen::Vector3d normal;
  Eigen::Vector3d d_point;
  Eigen::Vector3d d_log_half_axes;
};

Distance CuboidDistance(const Eigen::Vector3d& half_axes, const Eigen::Vector3d& x) {
  Eigen::Index face = 0;
  const double value = (x.cwiseAbs() - half_axes).maxCoeff(&face);
  const Eigen::Vector3d normal = Eigen::Vector3d::Unit(face) * std::copysign(1.0, x[face]);
  return {value, normal, normal, -half_axes[face] * Eigen::Vector3d::Unit(face)};
}

Distance SuperquadricDistance(const Eigen::Vector3d& half_axes, double q,
                              const Eigen::Vector3d& x) {
  const Eigen::Array3d inverse_axes = half_axes.array().inverse();
  const Eigen::Array3d u = x.array() * inverse_axes;
  if (!(u.abs().maxCoeff() > kNearCentre)) {
    return {-half_axes.minCoeff(), Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Zero(),
            Eigen::Vector3d::Zero()};
  }
  const Norm norm = QNorm(u, q);
  const Eigen::Vector3d gradient = (norm.slopes * inverse_axes).matrix();  // dF / dx
  const double slope = gradient.norm();
  const double value = (norm.value - 1.0) / slope;
  const Eigen::Vector3d d_slope =
      ((norm.hessian * gradient.cwiseProduct(inverse_axes.matrix())).array() * inverse_axes)
          .matrix() /
      slope;
  const Eigen::Vector3d d_point = (gradient - value * d_slope) / slope;
  return {value, gradient / slope, d_point,
          -x.cwiseProduct(d_point) + value / (slope * slope) * gradient.cwiseAbs2()};
}

}  // namespace

double SurfaceDistance(const Landmark& landmark, const Eigen::Vector3d& point,
                       LandmarkJacobian1* jacobian, Eigen::Vector3d* normal) {
  const Eigen::Matrix3d rotation = landmark.frame_from_object.rotation.toRotationMatrix();
  const Eigen::Vector3d from_centre = point - landmark.Centre();
  const Eigen::Vector3d x = rotation.transpose() * from_centre;
  const double q = DualExponent(landmark.shape_exponent);
  const Distance distance = std::isinf(q) ? CuboidDistance(landmark.half_axes, x)
                                          : SuperquadricDistance(landmark.half_axes, q, x);
  if (normal != nullptr) *normal = rotation * distance.normal;
  if (jacobian != nullptr) {
    const Eigen::Vector3d d_point = rotation * distance.d_point;
    *jacobian << d_point.cross(from_centre).transpose(), -d_point.transpose(),
        distance.d_log_half_axes.transpose();
  }
  return distance.value;
}

}  // namespace soslam

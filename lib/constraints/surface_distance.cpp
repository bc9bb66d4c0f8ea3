// SPDX-License-Identifier: BSD-3-Clause
#include "constraints/surface_distance.h"

#include <cmath>

namespace soslam {
namespace {

// Superquadrics with a larger q are treated as cuboids, as by BodySurface.
constexpr double kLargestQ = 200.0;
constexpr double kNearCentre = 1e-9;

// F of the point u = (x / a, y / b, z / c), with derivatives by u.
struct Norm {
  double value;
  Eigen::Array3d slopes;
  Eigen::Matrix3d hessian;
};

Norm MaximumNorm(const Eigen::Array3d& u) {
  Eigen::Index face = 0;
  Norm norm = {u.abs().maxCoeff(&face), Eigen::Array3d::Zero(), Eigen::Matrix3d::Zero()};
  norm.slopes[face] = std::copysign(1.0, u[face]);
  return norm;
}

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

}  // namespace

double SurfaceDistance(const Landmark& landmark, const Eigen::Vector3d& point,
                       LandmarkJacobian1* jacobian, Eigen::Vector3d* normal) {
  const Eigen::Matrix3d rotation = landmark.frame_from_object.rotation.toRotationMatrix();
  const Eigen::Vector3d from_centre = point - landmark.Centre();
  const Eigen::Array3d x = (rotation.transpose() * from_centre).array();
  const Eigen::Array3d inverse_axes = landmark.half_axes.array().inverse();
  const Eigen::Array3d u = x * inverse_axes;
  if (!(u.abs().maxCoeff() > kNearCentre)) {
    if (jacobian != nullptr) jacobian->setZero();
    if (normal != nullptr) *normal = rotation.col(2);
    return -landmark.half_axes.minCoeff();
  }
  const double p = landmark.shape_exponent;
  const bool is_cuboid = !(p > 1.0) || p / (p - 1.0) > kLargestQ;
  const Norm norm = is_cuboid ? MaximumNorm(u) : QNorm(u, p / (p - 1.0));
  const Eigen::Vector3d gradient = (norm.slopes * inverse_axes).matrix();  // dF / dx
  const double slope = gradient.norm();
  const double distance = (norm.value - 1.0) / slope;
  if (normal != nullptr) *normal = rotation * gradient / slope;
  if (jacobian == nullptr) return distance;
  const Eigen::Vector3d d_slope =
      ((norm.hessian * gradient.cwiseProduct(inverse_axes.matrix())).array() * inverse_axes)
          .matrix() /
      slope;
  const Eigen::Vector3d d_point = (gradient - distance * d_slope) / slope;
  const Eigen::Vector3d d_log_half_axes =
      -x.matrix().cwiseProduct(d_point) + distance / (slope * slope) * gradient.cwiseAbs2();
  const Eigen::Vector3d d_point_in_frame = rotation * d_point;
  *jacobian << d_point_in_frame.cross(from_centre).transpose(), -d_point_in_frame.transpose(),
      d_log_half_axes.transpose();
  return distance;
}

}  // namespace soslam

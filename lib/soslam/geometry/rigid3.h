// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "soslam/base/description.h"

namespace soslam {

// A rigid motion. Variables are named target_from_source:
//   point_in_target = target_from_source * point_in_source.
// Quaternions are stored x, y, z, w (Eigen's and TUM's order) and have unit norm.
struct Rigid3d {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  // metres

  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const {
    return rotation * point + translation;
  }
  Rigid3d operator*(const Rigid3d& other) const {
    return {(rotation * other.rotation).normalized(), *this * other.translation};
  }
  Rigid3d Inverse() const {
    const Eigen::Quaterniond inverse = rotation.conjugate();
    return {inverse, -(inverse * translation)};
  }
  Eigen::Matrix4d Matrix() const {
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    matrix.topLeftCorner<3, 3>() = rotation.toRotationMatrix();
    matrix.topRightCorner<3, 1>() = translation;
    return matrix;
  }
};

template <typename Visitor>
void Describe(Visitor& visit, Rigid3d& rigid) {
  visit.Unit("rotation_xyzw", &rigid.rotation, "unit quaternion in the order x, y, z, w");
  visit.Field("translation", &rigid.translation, "metres, in the target frame");
}

// The skew-symmetric matrix with Skew(v) * w = v x w.
inline Eigen::Matrix3d Skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d skew;
  skew << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return skew;
}

// exp: rotation vector (rad) to rotation; log: its inverse, |result| <= pi.
Eigen::Quaterniond ExpRotation(const Eigen::Vector3d& rotation_vector);
Eigen::Vector3d LogRotation(const Eigen::Quaterniond& rotation);

// The smallest rotation that turns the direction `from` into that of `to`.
Eigen::Quaterniond RotationBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace soslam

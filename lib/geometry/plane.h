// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "geometry/rigid3.h"

namespace soslam {

// The points x with normal . x + offset = 0; unit normal, offset in metres. A support plane's
// normal points towards the supported object.
struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double offset = 0.0;

  double SignedDistance(const Eigen::Vector3d& point) const { return normal.dot(point) + offset; }
  Eigen::Vector4d Homogeneous() const { return {normal.x(), normal.y(), normal.z(), offset}; }
};

// The same plane in the target frame.
inline Plane Transform(const Rigid3d& target_from_source, const Plane& plane_in_source) {
  const Eigen::Vector3d normal_in_target = target_from_source.rotation * plane_in_source.normal;
  return {normal_in_target,
          plane_in_source.offset - normal_in_target.dot(target_from_source.translation)};
}

// Least squares point of planes; of several, that nearest to the frame's origin.
class PointOnPlanes {
 public:
  void Add(const Plane& plane, double weight = 1.0);
  Eigen::Vector3d Solve() const;

 private:
  Eigen::Matrix3d normal_matrix_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right_side_ = Eigen::Vector3d::Zero();
};

}  // namespace soslam

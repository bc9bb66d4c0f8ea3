// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "soslam/geometry/rigid3.h"

namespace soslam {

// The points x with normal . x + offset = 0; unit normal, offset in metres. A support plane's
// normal points towards the supported object.
struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double offset = 0.0;

  double SignedDistance(const Eigen::Vector3d& point) const { return normal.dot(point) + offset; }
  Eigen::Vector4d Homogeneous() const { return {normal.x(), normal.y(), normal.z(), offset}; }
};

template <typename Visitor>
void Describe(Visitor& visit, Plane& plane) {
  visit.Unit("normal", &plane.normal, "unit normal, towards the supported objects");
  visit.Field("offset", &plane.offset, "metres: normal . x + offset = 0");
}

// A plane in the target frame.
inline Plane Transform(const Rigid3d& target_from_source, const Plane& plane_in_source) {
  const Eigen::Vector3d normal_in_target = target_from_source.rotation * plane_in_source.normal;
  return {normal_in_target,
          plane_in_source.offset - normal_in_target.dot(target_from_source.translation)};
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/plane.h"

#include <Eigen/QR>

namespace soslam {

void PointOnPlanes::Add(const Plane& plane, double weight) {
  normal_matrix_ += weight * plane.normal * plane.normal.transpose();
  right_side_ -= weight * plane.offset * plane.normal;
}

Eigen::Vector3d PointOnPlanes::Solve() const {
  return normal_matrix_.completeOrthogonalDecomposition().solve(right_side_);
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "geometry/wireframe.h"
#include "support/random.h"

namespace soslam {

// The eight corners of a cuboid, in the frame that the landmark is given in.
inline std::vector<Eigen::Vector3d> CornersOf(const Landmark& cuboid) {
  std::vector<Eigen::Vector3d> corners;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d signs(i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0);
    corners.push_back(PointAt(cuboid, signs));
  }
  return corners;
}

// The tight box around the corners in TestCamera's image: OutlineBox rounds corners off.
inline Box BoxAroundCorners(const Landmark& cuboid_in_camera) {
  Eigen::AlignedBox2d around;
  for (const Eigen::Vector3d& corner : CornersOf(cuboid_in_camera)) {
    around.extend(*TestCamera().Project(corner));
  }
  return {around.min().x(), around.min().y(), around.max().x(), around.max().y()};
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/box_on_ground.h"

namespace soslam {

BoxOnGround::BoxOnGround(const std::array<BoxEdge, 4>& edges, const Rigid3d& camera_from_reference,
                         const UprightGround& ground) {
  Eigen::Matrix3d reference_from_ground;
  reference_from_ground << ground.x, ground.y, ground.normal;
  const Eigen::Matrix3d camera_from_ground =
      camera_from_reference.rotation.toRotationMatrix() * reference_from_ground;
  const Eigen::Vector3d origin = camera_from_reference * ground.origin;
  for (int i = 0; i < 4; ++i) {
    const BoxEdge& edge = edges[static_cast<size_t>(i)];
    normals.row(i) = edge.plane.transpose() * camera_from_ground;
    at_origin[i] = edge.plane.dot(origin);
    sigma_px[i] = edge.sigma_px;
    is_bound[i] = edge.is_bound ? 1.0 : 0.0;
  }
  optical_axis = camera_from_ground.row(2);
  origin_depth = origin.z();
}

}  // namespace soslam

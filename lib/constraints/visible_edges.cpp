// SPDX-License-Identifier: BSD-3-Clause
#include "constraints/visible_edges.h"

namespace soslam {

std::array<BoxEdge, 4> VisibleEdges(const std::array<BoxEdge, 4>& edges,
                                    const Landmark& landmark_in_camera) {
  std::array<BoxEdge, 4> visible = edges;
  for (size_t i = 0; i < edges.size(); ++i) {
    if (edges[i].is_bound) continue;
    for (const size_t neighbour : {(i + 1) % edges.size(), (i + 3) % edges.size()}) {
      const BoxEdge& bound = edges[neighbour];
      if (!bound.is_bound) continue;
      const Eigen::Vector3d tangent_point =
          FindSupportPoint(landmark_in_camera, edges[i].plane).point;
      if (bound.plane.dot(tangent_point) > 0.0) visible[i].is_bound = true;
    }
  }
  return visible;
}

}  // namespace soslam

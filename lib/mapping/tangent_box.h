// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>

#include "base/wide_loops.h"
#include "constraints/tangency.h"
#include "geometry/landmark.h"

namespace soslam {

// The edges of a detection's box as the back end compares them with a body. The depth of a tangent
// point is that of the centre times what it is of it on `start_in_camera`, whose shape exponent is
// that of the body and whose centre is in front: with depths that stay as they were, a smaller
// world would have smaller residuals. A centre nearer than a tenth of that, or behind the camera,
// counts as if it were there. Edges whose tangent point is not in front of the camera at the start
// are left out.
struct TangentBox {
  struct Edge {
    // In the camera frame; over sigma and the point's depth by the centre's.
    Eigen::Vector3d plane = Eigen::Vector3d::Zero();
    double per_px = 0.0;  // 1 / sigma
    int side = 0;         // which one of the box
    bool is_bound = false;
  };

  TangentBox(const std::array<BoxEdge, 4>& edges, const Landmark& start_in_camera);

  double shape_exponent;
  double least_depth_m;  // of the centre
  int num_edges = 0;
  std::array<Edge, 4> edges{};
};

// Edges side by side, with planes as in TangentBox::Edge, in a frame that is up to who sets them.
// Weights multiply losses; where there is no edge, it is 0.
struct alignas(kFourAlignment) FourEdges {
  ThreeFours planes{Four{}, Four{}, Four{} + 1.0};  // any but zero
  Four weights{};
  Four is_bound{};  // 1 or 0

  // `plane` may be that of the edge in another frame.
  void Set(size_t place, const Eigen::Vector3d& plane, const TangentBox::Edge& edge,
           double weight) {
    for (size_t i = 0; i < 3; ++i) planes[i][place] = plane[static_cast<int>(i)];
    weights[place] = weight;
    is_bound[place] = edge.is_bound ? 1.0 : 0.0;
  }
};

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/tangent_box.h"

namespace soslam {
namespace {

constexpr double kLeastDepth = 0.1;  // of the start's

}  // namespace

TangentBox::TangentBox(const std::array<BoxEdge, 4>& box_edges, const Landmark& start_in_camera)
    : shape_exponent(start_in_camera.shape_exponent),
      least_depth_m(kLeastDepth * start_in_camera.Centre().z()) {
  for (size_t i = 0; i < box_edges.size(); ++i) {
    const double depth_m = TangentDepth(box_edges[i], start_in_camera);
    if (!(depth_m > 0.0)) continue;
    const double by_centre_depth = depth_m / start_in_camera.Centre().z();
    edges[static_cast<size_t>(num_edges++)] = {
        box_edges[i].plane / (by_centre_depth * box_edges[i].sigma_px), 1.0 / box_edges[i].sigma_px,
        static_cast<int>(i), box_edges[i].is_bound};
  }
}

}  // namespace soslam

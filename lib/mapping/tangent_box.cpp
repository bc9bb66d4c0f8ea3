// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/tangent_box.h"

#include "base/wide_loops.h"
#include "geometry/support_of_four.h"

namespace soslam {
namespace {

constexpr double kLeastDepth = 0.1;  // of the start's

struct Body {
  Eigen::Matrix3d camera_from_object;
  Eigen::Vector3d half_axes;
  double shape_exponent;
  double centre_depth_m;
};

// TangentDepth of all edges, side by side.
SOSLAM_MULTIVERSION void FindTangentDepths(const std::array<BoxEdge, 4>& edges, const Body& body,
                                           std::array<double, 4>* depths_m) {
  ThreeFours plane_in_object{};
  for (size_t i = 0; i < 3; ++i) {
    const Four component = {edges[0].plane[i], edges[1].plane[i], edges[2].plane[i],
                            edges[3].plane[i]};
    for (size_t k = 0; k < 3; ++k) {
      plane_in_object[k] += body.camera_from_object(i, k) * component;
    }
  }
  SupportOfFour support;
  FindSupport(body.half_axes, body.shape_exponent, plane_in_object, &support);
  const ThreeFours contact = support.Contact(body.shape_exponent, plane_in_object);
  Four depths = Four{} + body.centre_depth_m;
  for (size_t k = 0; k < 3; ++k) depths += body.camera_from_object(2, k) * contact[k];
  Store(depths, depths_m->data());
}

}  // namespace

TangentBox::TangentBox(const std::array<BoxEdge, 4>& box_edges, const Landmark& start_in_camera)
    : shape_exponent(start_in_camera.shape_exponent),
      least_depth_m(kLeastDepth * start_in_camera.Centre().z()) {
  std::array<double, 4> depths_m;
  FindTangentDepths(box_edges,
                    {start_in_camera.frame_from_object.rotation.toRotationMatrix(),
                     start_in_camera.half_axes, shape_exponent, start_in_camera.Centre().z()},
                    &depths_m);
  for (size_t i = 0; i < box_edges.size(); ++i) {
    const double depth_m = depths_m[i];
    if (!(depth_m > 0.0)) continue;
    const double by_centre_depth = depth_m / start_in_camera.Centre().z();
    edges[static_cast<size_t>(num_edges++)] = {
        box_edges[i].plane / (by_centre_depth * box_edges[i].sigma_px), 1.0 / box_edges[i].sigma_px,
        static_cast<int>(i), box_edges[i].is_bound};
  }
}

}  // namespace soslam

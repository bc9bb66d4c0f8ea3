// SPDX-License-Identifier: BSD-3-Clause
#include "constraints/tangency.h"

#include <algorithm>
#include <cmath>

namespace soslam {
namespace {

// Lower limit of sigma: boxes of a few pixels are not more precise than this.
constexpr double kMinSigmaPx = 1.0;

constexpr int kMaxNewtonSteps = 20;
constexpr double kSettledExcess = 1e-10;  // px / sigma

}  // namespace

std::array<BoxEdge, 4> BoxEdges(const Camera& camera, const Box& box,
                                const std::array<bool, 4>& is_bound, double sigma_fraction) {
  const Eigen::Matrix3d to_plane = camera.Intrinsics().transpose();
  const auto lines = box.EdgeLines();
  std::array<BoxEdge, 4> edges;
  for (size_t i = 0; i < edges.size(); ++i) {
    const double outwards = i < 2 ? -1.0 : 1.0;
    const double side = i % 2 == 0 ? box.Width() : box.Height();
    edges[i] = {outwards * (to_plane * lines[i]), is_bound[i],
                std::max(kMinSigmaPx, sigma_fraction * side)};
  }
  return edges;
}

double Tangency(const BoxEdge& edge, const Landmark& landmark_in_camera, double depth_m,
                double bias_px, LandmarkJacobian1* jacobian) {
  const Eigen::Quaterniond& rotation = landmark_in_camera.frame_from_object.rotation;
  const SupportValue support =
      SupportFunction(landmark_in_camera.half_axes, landmark_in_camera.shape_exponent,
                      rotation.conjugate() * edge.plane);
  const double weight = 1.0 / (depth_m * edge.sigma_px);
  const double outside = weight * (edge.plane.dot(landmark_in_camera.Centre()) + support.extent) -
                         bias_px / edge.sigma_px;
  const bool is_free = edge.is_bound && outside > 0.0;
  if (jacobian != nullptr) {
    const Eigen::Vector3d contact = rotation * support.contact;
    *jacobian << contact.cross(edge.plane).transpose(), edge.plane.transpose(),
        support.by_log_half_axes.transpose();
    *jacobian *= is_free ? 0.0 : weight;
  }
  return is_free ? 0.0 : outside;
}

double TangentDepth(const BoxEdge& edge, const Landmark& landmark_in_camera) {
  return FindSupportPoint(landmark_in_camera, edge.plane).point.z();
}

// Newton's method for the outward shift of the edge at which it is tangent to the silhouette. The
// distance to the tangent plane is convex in the shift, so steps do not overshoot after the first.
double OutlineExcess(const BoxEdge& edge, const Landmark& landmark_in_camera,
                     LandmarkJacobian1* jacobian) {
  BoxEdge moved = edge;
  moved.is_bound = false;
  double excess = 0.0;
  for (int i = 0; i < kMaxNewtonSteps; ++i) {
    const double depth_m = TangentDepth(moved, landmark_in_camera);
    const double step = Tangency(moved, landmark_in_camera, depth_m, 0.0, jacobian);
    excess += step;
    moved.plane.z() -= step * edge.sigma_px;
    if (!(std::abs(step) > kSettledExcess)) break;
  }
  if (!edge.is_bound || !(excess > 0.0)) return excess;
  if (jacobian != nullptr) jacobian->setZero();
  return 0.0;
}

}  // namespace soslam

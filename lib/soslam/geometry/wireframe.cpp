// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/geometry/wireframe.h"

#include <cmath>
#include <numbers>

namespace soslam {

Eigen::Vector3d PointAt(const Landmark& landmark, const Eigen::Vector3d& multiples) {
  return landmark.frame_from_object * landmark.half_axes.cwiseProduct(multiples);
}

std::array<LineSegment3, 12> UnitCuboidEdges() {
  std::array<LineSegment3, 12> edges;
  for (int i = 0; i < 12; ++i) {
    const int along = i / 4;
    Eigen::Vector3d start;
    start[along] = -1.0;
    start[(along + 1) % 3] = i & 2 ? 1.0 : -1.0;
    start[(along + 2) % 3] = i & 1 ? 1.0 : -1.0;
    edges[i] = {start, start + 2.0 * Eigen::Vector3d::Unit(along)};
  }
  return edges;
}

std::vector<LineSegment3> VisibleCuboidEdges(const Landmark& landmark_in_camera) {
  const Eigen::Vector3d camera_in_unit_body =
      landmark_in_camera.frame_from_object.Inverse().translation.cwiseQuotient(
          landmark_in_camera.half_axes);
  std::vector<LineSegment3> visible;
  for (const LineSegment3& edge : UnitCuboidEdges()) {
    const auto& [start, end] = edge;
    const bool is_visible =
        ((start.array() == end.array()) && (start.cwiseProduct(camera_in_unit_body).array() > 1.0))
            .any();
    if (is_visible) visible.push_back(edge);
  }
  return visible;
}

std::vector<Eigen::Vector3d> SilhouettePoints(const Camera& camera,
                                              const Landmark& landmark_in_camera) {
  constexpr int kDirections = 90;
  std::vector<Eigen::Vector3d> points;
  if (!IsInFront(landmark_in_camera)) return points;
  Eigen::Vector3d last = landmark_in_camera.Centre();
  for (int i = 0; i < kDirections; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kDirections;
    const auto end =
        FindSilhouettePoint(camera, landmark_in_camera, {std::cos(angle), std::sin(angle)}, last);
    if (!end) return {};
    last = end->point;
    points.push_back(last);
  }
  return points;
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "constraints/edges_on_surface.h"

#include <limits>

#include "geometry/mirror_mapping.h"

namespace soslam {

EdgesOnSurface::EdgesOnSurface(const Camera& camera, const Landmark& landmark_in_camera,
                               const std::vector<Eigen::Vector2d>& edge_pixels) {
  const VisibleSurface surface(camera, landmark_in_camera);
  for (const Eigen::Vector2d& pixel : edge_pixels) {
    const auto point = surface.FromPixel(pixel);
    if (point) edges_.push_back({pixel, point->in_object});
  }
}

std::optional<Eigen::Vector2d> EdgesOnSurface::Nearest(
    const Eigen::Vector3d& point_in_object) const {
  double smallest = std::numeric_limits<double>::infinity();
  std::optional<Eigen::Vector2d> nearest;
  for (const Edge& edge : edges_) {
    const double squared = (edge.in_object - point_in_object).squaredNorm();
    if (!(squared < smallest)) continue;
    smallest = squared;
    nearest = edge.pixel;
  }
  return nearest;
}

}  // namespace soslam

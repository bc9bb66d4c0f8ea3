// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "geometry/camera.h"
#include "geometry/landmark.h"

namespace soslam {

// Intersections of edge pixels' rays with a landmark's surface, eq. (19).
class EdgesOnSurface {
 public:
  EdgesOnSurface(const Camera& camera, const Landmark& landmark_in_camera,
                 const std::vector<Eigen::Vector2d>& edge_pixels);

  // The edge pixel whose surface point is nearest to a point, in 3D; of several the first. None
  // when no edge is on the surface.
  std::optional<Eigen::Vector2d> Nearest(const Eigen::Vector3d& point_in_object) const;

 private:
  struct Edge {
    Eigen::Vector2d pixel;
    Eigen::Vector3d in_object;  // m
  };
  std::vector<Edge> edges_;
};

}  // namespace soslam

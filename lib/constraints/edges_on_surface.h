// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "geometry/batch.h"
#include "geometry/camera.h"
#include "geometry/landmark.h"

namespace soslam {

// Edge pixels where their rays meet a landmark's surface, eq. (19).
class EdgesOnSurface {
 public:
  EdgesOnSurface(const Camera& camera, const Landmark& landmark_in_camera,
                 const std::vector<Eigen::Vector2d>& edge_pixels);

  // The edge pixel that is nearest in space; of several the first. None when no edge is on the
  // surface.
  std::optional<Eigen::Vector2d> Nearest(const Eigen::Vector3d& point_in_object) const;

 private:
  std::vector<BatchOfVectors> in_object_;  // what is left of the last one is NaN
  std::vector<Eigen::Vector2d> pixels_;
};

}  // namespace soslam

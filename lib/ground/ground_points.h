// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "model/map_points.h"
#include "model/sequence.h"

namespace soslam {

// Sparse point with its uncertainty.
struct GroundPoint {
  Eigen::Vector3d position_in_world;
  Eigen::Matrix3d covariance;      // from its reprojection error and the cameras that observe it
  std::vector<int> frame_indices;  // of the frames that observe it
};

// Points that at least two frames of the sequence observe, in front of their cameras.
std::vector<GroundPoint> GroundPoints(const Sequence& sequence,
                                      const std::vector<MapPoint>& points);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

namespace soslam {

// Image point of a sparse point.
struct PointObservation {
  int frame_id = 0;  // Frame::id: the 0-based row in the dataset's image list
  // In the image as it is stored, lens distortion included; (0, 0) is the centre of the top-left
  // pixel.
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
};

// Sparse point of structure from motion.
struct MapPoint {
  Eigen::Vector3d position_in_world = Eigen::Vector3d::Zero();
  double reprojection_error_px = 0.0;  // mean over its observations; 0 where it is not known
  std::vector<PointObservation> observations;
};

}  // namespace soslam

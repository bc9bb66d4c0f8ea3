// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "model/sequence.h"

namespace soslam {

// Odometry drift as a random walk: every motion between consecutive frames has an independent
// error, a small rotation and a translation, both isotropic.
class Drift {
 public:
  Drift(const std::vector<Frame>& frames, double rotation_sigma_rad, double translation_sigma_m);

  // Covariance (m^2, world axes) of a point's position relative to the camera of one frame, when it
  // is exactly known relative to the camera of the other. A rotation error moves the point by its
  // lever arm from the camera position at that time.
  Eigen::Matrix3d PointCovariance(int frame_index, int other_frame_index,
                                  const Eigen::Vector3d& point_in_world) const;

 private:
  double rotation_variance_;
  double translation_variance_;
  Eigen::Vector3d origin_;  // of the positions summed below
  // Prefix sums of camera positions and of their outer products: element i covers the frames before
  // i.
  std::vector<Eigen::Vector3d> position_sums_;
  std::vector<Eigen::Matrix3d> product_sums_;
};

}  // namespace soslam

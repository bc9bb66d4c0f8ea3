// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "model/sequence.h"

namespace soslam {

// How far odometry may have drifted, as a random walk: every motion from one frame to the next has
// an independent error, a small rotation and a translation with the same spread in all directions.
class Drift {
 public:
  Drift(const std::vector<Frame>& frames, double rotation_sigma_rad, double translation_sigma_m);

  // The covariance (m^2, world axes) of where a point is for the camera of one frame, when its
  // place was exact for that of the other. An error of rotation moves the point by its lever, from
  // where the camera was.
  Eigen::Matrix3d PointCovariance(int frame_index, int other_frame_index,
                                  const Eigen::Vector3d& point_in_world) const;

 private:
  double rotation_variance_;
  double translation_variance_;
  Eigen::Vector3d origin_;  // of the positions below
  // Sums over the frames before each one, of camera positions and their outer products.
  std::vector<Eigen::Vector3d> position_sums_;
  std::vector<Eigen::Matrix3d> product_sums_;
};

}  // namespace soslam

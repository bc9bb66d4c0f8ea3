// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/rigid3.h"
#include "planes/camera_holding.h"

namespace soslam {

// Prior on the up direction from the cameras alone, before boxes are used.
struct UpPrior {
  // Information (1 / rad^2): an upward unit vector u in the world costs 0.5 u^T information u.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d up_in_world = Eigen::Vector3d::UnitZ();  // the one of least cost
};

// Unit vector of least cost (smallest eigenvector of the information), with the sign on the side of
// `above`.
Eigen::Vector3d LowestCostUp(const Eigen::Matrix3d& information, const Eigen::Vector3d& above);

// Weight of each camera: cameras whose optical axes are closer than about `correlation_rad` are
// correlated and count together as one; all weights are 1 where it is zero.
std::vector<double> CameraWeights(const std::vector<Rigid3d>& world_from_camera,
                                  double correlation_rad);

// Prior on up from the way people and vehicles hold cameras. Level cameras have nearly level x
// axes, and less exactly level optical axes; for other holdings see AxesOf. At least one pose;
// sigmas in radians. The sign of up is that of most cameras.
UpPrior UpPriorFromCameras(const std::vector<Rigid3d>& world_from_camera, double roll_sigma,
                           double pitch_sigma, double correlation_rad,
                           CameraHolding holding = CameraHolding::kLevel);

}  // namespace soslam

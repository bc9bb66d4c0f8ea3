// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/rigid3.h"

namespace soslam {

// What the way in which people and vehicles hold cameras says about where up is: x axes are nearly
// level, optical axes less so.
struct CameraAttitude {
  // Half u^T information u is the cost of an upward unit vector u in the world (1 / rad^2).
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d up_in_world = Eigen::Vector3d::UnitZ();  // the one of lowest cost
};

// From at least one pose; sigmas in radians. Cameras whose optical axes are closer than about
// `correlation_rad` count together as one. Of the two directions of lowest cost, the one that most
// cameras have above them.
CameraAttitude AttitudeOf(const std::vector<Rigid3d>& world_from_camera, double roll_sigma,
                          double pitch_sigma, double correlation_rad);

}  // namespace soslam

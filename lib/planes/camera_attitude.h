// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/rigid3.h"
#include "planes/camera_holding.h"

namespace soslam {

// What is known about up before boxes are looked at.
struct CameraAttitude {
  // Half u^T information u is the cost of an upward unit vector u in the world (1 / rad^2).
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d up_in_world = Eigen::Vector3d::UnitZ();  // the one of lowest cost
};

// Of the two unit vectors of lowest cost the one on the side of `above`.
Eigen::Vector3d LowestCostUp(const Eigen::Matrix3d& information, const Eigen::Vector3d& above);

// What each camera counts when cameras whose optical axes are closer than about `correlation_rad`
// count together as one; 1 where that is zero.
std::vector<double> ShareOfCameras(const std::vector<Rigid3d>& world_from_camera,
                                   double correlation_rad);

// What the way in which people and vehicles hold cameras says: held level, x axes are nearly level,
// optical axes less so; held otherwise, other axes are. From at least one pose; sigmas in radians.
// Up is where most cameras have it.
CameraAttitude AttitudeOf(const std::vector<Rigid3d>& world_from_camera, double roll_sigma,
                          double pitch_sigma, double correlation_rad,
                          CameraHolding holding = CameraHolding::kLevel);

}  // namespace soslam

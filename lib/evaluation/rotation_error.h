// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace soslam {

// Renaming of a box's axes: of the 24 rotations of the cube, the one from the new names to the old
// ones that leaves the smallest angle (rad) to the axes of the truth.
struct NearestAxes {
  Eigen::Matrix3d old_from_new;
  double angle = 0.0;
};
NearestAxes NearestAxesOf(const Eigen::Quaterniond& frame_from_estimate,
                          const Eigen::Quaterniond& frame_from_truth);

// The paper's Rot, rad: the smallest rotation that brings the estimate's three axes onto any axes
// of the truth, over the 24 rotations of the cube. It does not detect quarter turns.
double RotationError(const Eigen::Quaterniond& frame_from_estimate,
                     const Eigen::Quaterniond& frame_from_truth);

// The angle (rad, in [0, pi/2]) between the x axes about the truth's z axis, modulo half a turn:
// the mirror plane has no front or back. pi/2 when the estimate's x axis is the truth's z axis.
double YawError(const Eigen::Quaterniond& frame_from_estimate,
                const Eigen::Quaterniond& frame_from_truth);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

#include "geometry/landmark.h"
#include "initialisation/box_on_ground.h"
#include "initialisation/upright.h"
#include "initialisation/upright_observation.h"

namespace soslam {

// At a given yaw and with the prior's ratio, the tangencies are linear in the foot and the half
// height c: the least squares solution over the measured edges, and over a bound that it would not
// reach. Tangent points are at their depths on the solution itself, found by repetition.
//
// Four equations A x = b for three unknowns leave one direction n with n^T A = 0. Whatever the
// weights W, the residuals of the least squares solution are the multiple of W^-2 n that makes A x
// = b + r solvable. Repetition changes weights only, so that A is inverted once for a yaw.
class ClosedForm {
 public:
  explicit ClosedForm(const UprightObservation& observation);

  // The body on the ground of the observation's plane, and its tangent depths. None when fewer than
  // three edges are measured, which leaves the size open, or when the body would not be in front of
  // the camera.
  std::optional<StartAtYaw> At(double yaw) const;

  // Whether at least three edges are measured.
  bool HasEnoughEdges() const { return (box_.is_bound == 0.0).count() >= 3; }

 private:
  struct System;
  System SystemAt(double yaw) const;
  Eigen::Array4d Residuals(const System& system, const Eigen::Array4d& depths_m) const;

  BoxOnGround box_;
  Eigen::Vector3d proportions_;  // (a, b, c) / c
  double shape_exponent_;
};

// The same for one yaw only, as a landmark in the camera frame.
std::optional<Landmark> SolveAtYaw(const UprightObservation& observation, double yaw);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "geometry/landmark.h"
#include "initialisation/box_on_ground.h"
#include "initialisation/upright.h"
#include "initialisation/upright_observation.h"

namespace soslam {

// The tangencies of a body of known proportions to a box's edges: linear in foot and half height c
// at a given yaw, F foot + a c = b. Only a depends on the yaw.
struct BoxEquations {
  explicit BoxEquations(const UprightObservation& observation);

  BoxOnGround box;
  Eigen::Vector3d proportions;  // (a, b, c) / c
  Eigen::Vector3d log_proportions;
  double shape_exponent;
  Eigen::Matrix<double, 4, 2> without_foot;  // N with N^T F = 0, orthonormal
  Eigen::Matrix<double, 2, 4> foot_by_b;     // pseudo-inverse of F
};

// Bodies with the prior's ratio at given yaws: the least squares solution over the measured edges,
// and over a bound that it would not reach. Tangent points are at their depths on the solution
// itself, found by repetition. Four yaws are solved side by side, in wide registers.
//
// N^T a c = N^T b is what the equations say of c. In n = N t, t orthogonal to N^T a, no body
// changes the residuals. Whatever their weights W = diag(1 / (depth sigma_px)), those of the least
// squares solution are the multiple of W^-2 n by which b has to change for there to be a solution.
// Repetition changes weights only.
class ClosedForm {
 public:
  explicit ClosedForm(const UprightObservation& observation) : equations_(observation) {}

  // The body at each of these yaws (rad) on the ground of the observation's plane, and its tangent
  // depths. None when fewer than three edges are measured, which leaves the size open, or when the
  // body would not be in front of the camera, in any repetition. Other yaws do not change a body by
  // a bit.
  std::vector<std::optional<StartAtYaw>> At(const std::vector<double>& yaws) const;
  std::optional<StartAtYaw> At(double yaw) const { return At(std::vector{yaw}).front(); }

  // Whether at least three edges are measured.
  bool HasEnoughEdges() const { return (equations_.box.is_bound == 0.0).count() >= 3; }

 private:
  BoxEquations equations_;
};

// The same for one yaw only, as a landmark in the camera frame.
std::optional<Landmark> SolveAtYaw(const UprightObservation& observation, double yaw);

}  // namespace soslam

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

// Tangency equations of an object of known proportions and the edges of a box. At a given yaw they
// are linear in its foot and half height c: F foot + a c = b. Only a depends on the yaw.
struct BoxEquations {
  explicit BoxEquations(const UprightObservation& observation);

  BoxOnGround box;
  Eigen::Vector3d proportions;  // (a, b, c) / c
  Eigen::Vector3d log_proportions;
  double shape_exponent;
  Eigen::Matrix<double, 4, 2> without_foot;  // N with N^T F = 0, orthonormal
  Eigen::Matrix<double, 2, 4> foot_by_b;     // pseudo-inverse of F
};

// Closed-form solution at given yaws for an object with the prior's ratio: least squares over the
// measured edges, and over a bound edge that the object would not reach otherwise. The depths of
// the tangent points are those on the solution itself, found by fixed-point iteration. Four yaws
// are solved at once (SIMD).
//
// Without the foot, N^T a c = N^T b remains for c. The vector n = N t, with t orthogonal to N^T a,
// spans the left null space of (F, a): n^T r is the same for the residuals r of all objects. With
// weights W = diag(1 / (depth sigma_px)), the residuals of the least squares solution are the
// multiple of W^-2 n with this n^T r. The iteration changes only W.
class ClosedForm {
 public:
  explicit ClosedForm(const UprightObservation& observation) : equations_(observation) {}

  // The object at each of these yaws (rad) on the ground of the observation's plane, and its
  // tangent depths. None if fewer than three edges are measured, which leaves the size
  // undetermined, or if the object of any iteration is not wholly in front of the camera. A
  // solution does not depend on the other yaws, to the last bit.
  std::vector<std::optional<StartAtYaw>> At(const std::vector<double>& yaws) const;
  std::optional<StartAtYaw> At(double yaw) const { return At(std::vector{yaw}).front(); }

  // True if at least three edges are measured.
  bool HasEnoughEdges() const { return (equations_.box.is_bound == 0.0).count() >= 3; }

 private:
  BoxEquations equations_;
};

// ClosedForm::At for a single yaw, as a landmark in the camera frame.
std::optional<Landmark> SolveAtYaw(const UprightObservation& observation, double yaw);

}  // namespace soslam

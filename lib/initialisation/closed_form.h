// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

#include "initialisation/upright.h"
#include "initialisation/upright_observation.h"

namespace soslam {

// Closed-form solution at a given yaw for an object with the prior's ratio: least squares over the
// measured edges, and over a one-sided edge that the object would not reach otherwise. The depths
// of the tangent points are those on the solution itself, found by fixed-point iteration.
//
// The tangency equations of the four edges are linear in the foot and the half height c:
// F foot + a c = b, and only a depends on the yaw. With N^T F = 0, N^T a c = N^T b remains for c.
// The vector n = N t, with t orthogonal to N^T a, spans the left null space of (F, a): n^T r is the
// same for the residuals r of all objects. With weights W = diag(1 / (depth sigma_px)), the
// residuals of the least squares solution are the multiple of W^-2 n with this n^T r. The iteration
// changes only W.
class ClosedForm {
 public:
  explicit ClosedForm(const UprightObservation& observation);

  // The object at this yaw (rad) on the ground of the observation's plane. None if fewer than three
  // edges are measured, which leaves the size undetermined, or if the object of any iteration is
  // not wholly in front of the camera.
  std::optional<UprightVector> At(double yaw) const;

  // True if at least three edges are measured.
  bool HasEnoughEdges() const { return (is_one_sided_ == 0.0).count() >= 3; }

 private:
  // Coefficients of the half height at a yaw.
  struct HalfHeightCoefficients {
    Eigen::Array4d residuals;       // a
    Eigen::Array4d tangent_depths;  // of the tangent points, relative to the foot
    double nearest_depth;           // of the object's nearest point, likewise
  };
  HalfHeightCoefficients CoefficientsAt(double yaw) const;

  // The planes behind the box's edges (BoxEdge::plane) in the ground frame of the object's support
  // plane, where a yaw is a rotation about z: normals as rows, and values at its origin (px m).
  Eigen::Matrix<double, 4, 3> normals_;
  Eigen::Array4d at_origin_;
  Eigen::Array4d sigma_px_;
  Eigen::Array4d is_one_sided_;   // 1 or 0
  Eigen::Vector3d optical_axis_;  // of the camera, in the ground frame
  double origin_depth_;           // depth of the ground's origin, m
  Eigen::Vector3d proportions_;   // (a, b, c) / c
  ShapeExponents shape_exponents_;
  Eigen::Matrix<double, 4, 2> without_foot_;  // N, orthonormal
  Eigen::Matrix<double, 2, 4> foot_by_b_;     // pseudo-inverse of F
};

}  // namespace soslam

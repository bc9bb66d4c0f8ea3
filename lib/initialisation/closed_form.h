// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <optional>

#include "constraints/tangency.h"
#include "geometry/landmark.h"
#include "initialisation/upright.h"
#include "initialisation/upright_observation.h"

namespace soslam {

// The box of a detection in the ground frame of its object's support plane, where a yaw is a
// rotation about z.
struct BoxOnGround {
  // `edges` and `ground` in the camera frame.
  BoxOnGround(const std::array<BoxEdge, 4>& edges, const UprightGround& ground);

  // The planes behind the edges (BoxEdge::plane) in the ground frame: normals as rows, and values
  // at the ground's origin (px m).
  Eigen::Matrix<double, 4, 3> normals;
  Eigen::Array4d at_origin;
  Eigen::Array4d sigma_px;
  Eigen::Array4d is_bound;       // 1 or 0
  Eigen::Vector3d optical_axis;  // of the camera, in the ground frame
  double origin_depth;           // depth of the ground's origin, m
};

// Cosine and sine of an object's yaw.
struct Heading {
  explicit Heading(double yaw) : cosine(std::cos(yaw)), sine(std::sin(yaw)) {}

  // Rotates a direction from the ground frame into the object frame.
  Eigen::Vector3d ToObjectFrame(const Eigen::Vector3d& direction) const {
    return {cosine * direction.x() + sine * direction.y(),
            cosine * direction.y() - sine * direction.x(), direction.z()};
  }

  double cosine;
  double sine;
};

// An upright object and the depths (m) of its tangent points at the four edges.
struct ClosedFormSolution {
  UprightVector parameters;
  Eigen::Array4d depths_m;
};

// Closed-form solution at a given yaw for an object with the prior's ratio: least squares over the
// measured edges, and over a bound edge that the object would not reach otherwise. The depths of
// the tangent points are those on the solution itself, found by fixed-point iteration.
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
  std::optional<ClosedFormSolution> At(double yaw) const;

  // True if at least three edges are measured.
  bool HasEnoughEdges() const { return (box_.is_bound == 0.0).count() >= 3; }

 private:
  // Coefficients of the half height at a heading.
  struct HalfHeightCoefficients {
    Eigen::Array4d residuals;       // a
    Eigen::Array4d tangent_depths;  // of the tangent points, relative to the foot
    double nearest_depth;           // of the object's nearest point, likewise
  };
  HalfHeightCoefficients CoefficientsAt(const Heading& heading) const;

  BoxOnGround box_;
  Eigen::Vector3d proportions_;  // (a, b, c) / c
  double shape_exponent_;
  Eigen::Matrix<double, 4, 2> without_foot_;  // N, orthonormal
  Eigen::Matrix<double, 2, 4> foot_by_b_;     // pseudo-inverse of F
};

}  // namespace soslam

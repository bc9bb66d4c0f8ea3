// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/loss_function.h>

#include <Eigen/Core>
#include <optional>

#include "soslam/constraints/landmark_terms.h"
#include "soslam/initialisation/object_evidence.h"
#include "soslam/initialisation/upright.h"

namespace soslam {

// Least squares solution over boxes and priors at a given yaw. The tangencies of a cuboid are
// linear in its foot and its three half axes; the prior's ratio adds soft equations. The solution
// is iterated: the Huber weights of the edges (residuals in px / sigma), the tangent depths, for
// other exponents the derivatives of the support function by the half axes, and the cost of a known
// size are those at the previous solution. Unlike the SVD of dual quadrics it does not need a wide
// baseline: plane and ratio determine what parallax does not. If the height is free, that of the
// foot is one more linear unknown. A round that fails leaves the body of the one before.
class BodyAtYaw {
 public:
  // Keeps a reference to the evidence.
  explicit BodyAtYaw(const ObjectEvidence& evidence);

  // The body at this yaw (rad, see Yaw). None if the views do not determine it, or if it is not in
  // front of all cameras.
  std::optional<Landmark> Solve(double yaw) const;

 private:
  struct Body {
    double yaw = 0.0;
    Eigen::Vector2d foot;       // on the ground's x and y, m
    double height_m = 0.0;      // of the foot over the plane
    Eigen::Vector3d half_axes;  // m
  };
  // Normal equations in foot x, foot y, a, b, c and the foot's height above the plane.
  struct LinearSystem;

  Landmark MakeLandmark(const Body& body) const;
  bool Step(int round, Body* body) const;
  void AddView(const BoxView& view, const Landmark& landmark, const Body& body, bool is_first,
               LinearSystem* system) const;

  const ObjectEvidence& evidence_;
  UprightParametrisation upright_;
  std::optional<RatioRows> ratio_;
  ceres::HuberLoss loss_;
  Body start_;
};

}  // namespace soslam

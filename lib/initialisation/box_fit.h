// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>

#include "initialisation/box_on_ground.h"
#include "initialisation/quadratic_model.h"
#include "initialisation/ratio_rows.h"
#include "initialisation/upright_observation.h"

namespace soslam {

// The sum of the BoxTerm, RatioTerm, AxisTerm and yaw prior costs of an upright object, as a
// function of its UprightVector on the observation's support plane.
class BoxFit {
 public:
  // Keeps a reference to the observation.
  explicit BoxFit(const UprightObservation& observation);

  // The costs to second order at the parameters `at`, with the tangent points of the four edges at
  // these depths (m); and the depths that they have on `start`.
  QuadraticModel<6> Evaluate(const Eigen::Array4d& depths_m, const UprightVector& at) const;
  Eigen::Array4d TangentDepths(const UprightVector& start) const;

  // Levenberg-Marquardt over these and further costs from `start`, with the tangent depths fixed at
  // those of `start`; yaw fixed or free. Returns the total cost, which is not finite if it is not
  // finite at the start.
  double Minimise(const LandmarkCosts& further, bool yaw_is_free, UprightVector* start) const;

  // Smallest depth (m) of any point of the object.
  double NearestDepth(const UprightVector& at) const;
  double CostAtOwnDepths(const UprightVector& at) const {
    return Evaluate(TangentDepths(at), at).cost;
  }
  const UprightGround& ground() const { return ground_; }

 private:
  void AddRatio(const Eigen::Vector3d& log_half_axes, QuadraticModel<6>* sum) const;
  // Residual of AxisTerm or of the yaw prior, and its derivative by the yaw (rad).
  struct YawRow {
    double residual = 0.0;
    double by_yaw = 0.0;
  };
  std::array<YawRow, 2> YawRows(double yaw, const Heading& heading_of_yaw) const;

  const UprightObservation& observation_;
  UprightGround ground_;
  BoxOnGround box_;
  RatioRows ratio_;
  Heading twice_the_axis_;  // at twice the yaw of the world's axis
};

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "initialisation/box_on_ground.h"
#include "initialisation/fit_four_yaws.h"
#include "initialisation/quadratic_model.h"
#include "initialisation/ratio_rows.h"
#include "initialisation/upright_observation.h"

namespace soslam {

// The sum of the BoxTerm, RatioTerm, AxisTerm and yaw prior costs of an upright object, as a
// function of its UprightVector on the observation's support plane. A sweep over yaw spends most of
// its time here: a fit allocates nothing, and rotates only by the sine and cosine of the yaw.
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

  StartAtYaw StartAt(const UprightVector& parameters) const {
    return {parameters, Heading(parameters[0]), TangentDepths(parameters)};
  }
  // The same for many starts, without further costs and with the yaws fixed; four at once (SIMD).
  std::vector<FitAtYaw> MinimiseAtYaws(std::span<const StartAtYaw> starts) const;

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
  double YawCost(const StartAtYaw& start) const;

  const UprightObservation& observation_;
  UprightGround ground_;
  BoxOnGround box_;
  RatioRows ratio_;
  Heading twice_the_axis_;  // at twice the yaw of the world's axis
};

}  // namespace soslam

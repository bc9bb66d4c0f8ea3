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

// What BoxTerm, RatioTerm, AxisTerm and the yaw prior say together of an upright body, by its
// parameters on the ground of the observation's plane. A sweep over yaw spends its time here:
// nothing is allocated for a fit, and nothing but the sines of the yaw turned.
class BoxFit {
 public:
  // Keeps a reference to the observation.
  explicit BoxFit(const UprightObservation& observation);

  // The sum of the terms, tangent points at the depths (m) that they have on `start`.
  QuadraticModel<6> Evaluate(const Eigen::Array4d& depths_m, const UprightVector& at) const;
  Eigen::Array4d TangentDepths(const UprightVector& start) const;

  // Levenberg-Marquardt of this and further costs from `start`, whose tangent depths count; yaw
  // fixed or free. Returns the total cost, which is not finite when it is not at the start.
  double Minimise(const LandmarkCosts& further, bool yaw_is_free, UprightVector* start) const;

  StartAtYaw StartAt(const UprightVector& parameters) const {
    return {parameters, Heading(parameters[0]), TangentDepths(parameters)};
  }
  // The same without further costs and with yaws fixed, of all starts; four side by side.
  std::vector<FitAtYaw> MinimiseAtYaws(std::span<const StartAtYaw> starts) const;

  // Of the body's points, m.
  double NearestDepth(const UprightVector& at) const;
  double CostAtOwnDepths(const UprightVector& at) const {
    return Evaluate(TangentDepths(at), at).cost;
  }
  const UprightGround& ground() const { return ground_; }

 private:
  void AddRatio(const Eigen::Vector3d& log_half_axes, QuadraticModel<6>* sum) const;
  // What AxisTerm and the yaw prior say.
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
  Heading twice_the_axis_;  // of twice the yaw of the world's axis
};

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "initialisation/upright.h"
#include "initialisation/upright_observation.h"

namespace soslam {

// Failure of an observation for which ClosedForm has no solution at any yaw.
std::string WhyNoSolution(const UprightObservation& observation);

// Costs by which yaws are compared, besides the observation's own terms.
struct YawObjective {
  // Costs that are fitted as well, made for the given initial guess; may be empty.
  std::function<LandmarkCosts(const Landmark& start_in_camera)> fitted_costs;
  // Number of fits, each with costs made for the result of the previous one. More than one if they
  // depend on their initial guess.
  int rounds = 1;
  // A cost by which yaws are compared, but that is not fitted; may be empty.
  std::function<double(const Landmark& landmark_in_camera)> compared_cost;
};

// A landmark on the ground of its observation's plane (see UprightGround), and its cost.
struct UprightFit {
  UprightVector parameters;
  double cost;
  // Parts of `cost`. That of the fitted costs is known if the YawObjective has several rounds,
  // else 0.
  double fitted_cost = 0.0;
  double compared_cost = 0.0;
};

// The best landmark at each yaw of a grid over half a turn; none where there is no solution.
struct YawSweep {
  std::vector<double> yaw;  // rad, see Yaw
  std::vector<std::optional<UprightFit>> fits;

  std::vector<double> Costs() const;  // NaN where there is no landmark
  // Standard deviation of the yaw (rad) about the first of the optima, with exp(-cost) as its
  // likelihood. Optima are refined: their yaws lie between those of the grid.
  struct Optimum {
    double yaw;
    double cost;
  };
  double StandardDeviation(const std::vector<Optimum>& optima) const;
};
YawSweep SweepYaw(const UprightObservation& observation, const YawObjective& objective,
                  double step);

// Rank of a cost: those that are equal in single precision are not told apart, as their order would
// be that of rounding errors.
inline float RankOfCost(double cost) { return static_cast<float>(1.0 + cost); }

// Indices of the local minima of a circular curve, lowest first; for a flat minimum its first
// index. NaN counts as infinite.
std::vector<size_t> CircularMinima(const std::vector<double>& values);

// The best local optima of the sweep, with refined yaw, lowest RankOfCost first (if equal, the
// lower yaw), at most `max_count`. The max(max_count, 6) lowest minima of the grid are
// refined; optima that coincide are returned once. If the prior's attitude is free, they are then
// tilted (FitLeaning).
std::vector<UprightSolution> LocalOptima(const UprightObservation& observation,
                                         const YawObjective& objective, const YawSweep& sweep,
                                         size_t max_count);

}  // namespace soslam

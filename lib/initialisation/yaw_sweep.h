// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "initialisation/upright.h"
#include "initialisation/upright_observation.h"

namespace soslam {

// The failure of an observation for which ClosedForm finds nothing at any yaw.
std::string WhyNoSolution(const UprightObservation& observation);

// What makes one yaw better than another, besides the observation's own terms.
struct YawObjective {
  // What the landmark at each yaw is fitted to as well, starting from the given one; may be empty.
  std::function<LandmarkCosts(const Landmark& start_in_camera)> further_costs;
  // Costs are made anew of the result and fitted again, so many times in all, where they depend on
  // their start.
  int rounds = 1;
  // What counts on top for the yaw, but not for the fit; may be empty.
  std::function<double(const Landmark& landmark_in_camera)> extra_cost;
};

// A landmark on the ground of its observation's plane, see UprightGround.
struct UprightFit {
  UprightVector parameters;
  double cost;
  // Part of it: what the further costs of a YawObjective of several rounds say.
  double further_cost = 0.0;
};

// The landmark that is best at each yaw of a grid over half a turn. Entries without one are empty.
struct YawSweep {
  std::vector<double> yaw;  // rad, see Yaw
  std::vector<std::optional<UprightFit>> fits;

  std::vector<double> Costs() const;  // NaN where there is no landmark
  // The spread of the yaw (rad) about the first of its optima (yaw and cost; between those of the
  // grid), when exp(-cost) is its likelihood.
  struct Optimum {
    double yaw;
    double cost;
  };
  double StandardDeviation(const std::vector<Optimum>& optima) const;
};
YawSweep SweepYaw(const UprightObservation& observation, const YawObjective& objective,
                  double step);

// The indices of a circular curve's local minima, lowest first, of flat ones their first; NaN
// counts as high.
std::vector<size_t> CircularMinima(const std::vector<double>& values);

// The best local optima of the sweep, yaw refined, lowest cost first (where 1 + cost is equal
// in single precision, the lower yaw), at most `max_count`: of so many minima of the grid, and at
// least of six, the lowest ones are refined. Two of them may be one then.
std::vector<UprightSolution> LocalOptima(const UprightObservation& observation,
                                         const YawObjective& objective, const YawSweep& sweep,
                                         size_t max_count);

}  // namespace soslam

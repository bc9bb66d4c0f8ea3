// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "mapping/back_end.h"
#include "mapping/options.h"

namespace soslam {

// An object of a map beside the lowest minimum of its cost that was found.
struct ObjectMinimum {
  int object_index = 0;
  double cost = 0.0;         // solved from its landmark in the map
  double lowest_cost = 0.0;  // solved from any start
  Landmark lowest_in_world;

  // Whether it is above by more than the larger of 0.1 and a thousandth of the cost.
  bool IsAboveLowest() const;
};

// Solves each object of a map alone, with the map's poses and planes, from its landmark, and from
// this turned to eight yaws over half a turn and scaled by 0.8 and 1.25. Costs are those of
// residuals made for the landmark found. `input`: the map's landmarks as initial ones, the poses
// and planes of the map in its sequence.
std::vector<ObjectMinimum> CheckMinima(const BackEndInput& input, const OptimiseOptions& options,
                                       int threads);

// The probability of each object of a map that its x axis, modulo half a turn, is rather a quarter
// turn on. The object is solved alone, as in CheckMinima, from its landmark, and from the same body
// with the horizontal axes exchanged. Where that is no minimum of its own, the costs of both as
// they are count, without images. None for objects without a landmark. `dispersion`:
// SolverSummary::Dispersion() of the map.
std::vector<std::optional<double>> QuarterTurnProbabilities(const BackEndInput& input,
                                                            const OptimiseOptions& options,
                                                            double dispersion, int threads);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "soslam/mapping/back_end.h"
#include "soslam/mapping/options.h"

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
// residuals made for the landmark found, with what it does not show of texture and edges, and with
// edges weighed as at the map's landmark. Ends at the same body are no other minimum. `input`: the
// map's landmarks as initial ones, the poses and planes of the map in its sequence.
std::vector<ObjectMinimum> CheckMinima(const BackEndInput& input, const OptimiseOptions& options,
                                       int threads);

}  // namespace soslam

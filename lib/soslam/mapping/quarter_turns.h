// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "soslam/mapping/back_end.h"
#include "soslam/mapping/options.h"

namespace soslam {

// The probability of each object of a map that its x axis, modulo half a turn, is rather a quarter
// turn on. The object is solved alone (OptimiseObject), from its landmark, and from the same body
// with the horizontal axes exchanged. Where that is no minimum of its own, the costs of both as
// they are count, without images. None for objects without a landmark. `input`: the map's landmarks
// as initial ones, the poses and planes of the map in its sequence. `dispersion`:
// SolverSummary::Dispersion() of the map.
std::vector<std::optional<double>> QuarterTurnProbabilities(const BackEndInput& input,
                                                            const OptimiseOptions& options,
                                                            double dispersion, int threads);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "soslam/model/estimates.h"
#include "soslam/model/sequence.h"
#include "soslam/model/shape_prior.h"

namespace soslam {

// Turns the landmarks of a map, with the sequence's poses and planes, by half a turn about their z
// axes where pictures say that their fronts are at their backs, and states how probable the fronts
// are then: that it is the front and not the back, and that the object is not a quarter turn on.
void FaceFront(const Sequence& in_map, const std::vector<std::optional<ShapePrior>>& priors,
               MapEstimate* map);

}  // namespace soslam

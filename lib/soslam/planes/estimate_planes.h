// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "soslam/model/sequence.h"
#include "soslam/model/shape_prior.h"
#include "soslam/planes/options.h"
#include "soslam/planes/planes_estimate.h"
#include "soslam/planes/up_prior.h"

namespace soslam {

// Costs of the objects' boxes, and the cost expected from the boxes' noise alone.
struct BodyCosts {
  std::vector<std::optional<double>> of_objects;  // none: no body fits the boxes
  double expected = 0.0;
};

// Costs with an upright body of free height per object, at the up direction that is best for all
// objects among those that the up prior allows.
BodyCosts CostsOfUprightBodies(const Sequence& sequence,
                               const std::vector<std::optional<ShapePrior>>& priors,
                               const UpPrior& up_prior, const PlanesOptions& options, int threads);

// Estimates the planes that the sequence's upright objects stand on, from their boxes in several
// frames, the trajectory, the objects' priors, the prior on up, and the planes of points of the
// sequence's ground. None when there are none of these, and no object's views determine the
// height of its base (one view, or all from the same place).
std::optional<PlanesEstimate> FindPlanes(const Sequence& sequence,
                                         const std::vector<std::optional<ShapePrior>>& priors,
                                         const UpPrior& up_prior, const PlanesOptions& options,
                                         int threads);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "initialisation/upright_options.h"
#include "model/estimates.h"
#include "model/sequence.h"
#include "model/shape_prior.h"

namespace soslam {

// One upright landmark per object from all of its boxes, with the frames' estimated poses; without
// a prior, a cuboid of free ratio. See WeighViews for the correlation. Failures: moving,
// not_determined_by_its_views.
LandmarkEstimates InitialiseMultiView(const Sequence& sequence,
                                      const std::vector<std::optional<ShapePrior>>& priors,
                                      const UprightOptions& options, double view_correlation_deg,
                                      int threads);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "initialisation/semantic_table.h"
#include "model/sequence.h"
#include "planes/options.h"
#include "planes/planes_estimate.h"
#include "planes/up_prior.h"

namespace soslam {

// Planes under the most probable camera holding.
struct PlanesAndHolding {
  PlanesEstimate estimate;
  Sequence level;  // the sequence with poses that have the same up everywhere
};

// Finds the planes for each camera holding in kCameraHoldings; returns the most probable result.
// `views`: per frame, with the segments among which vertical edges are searched; empty to not use
// vertical edges.
PlanesAndHolding EstimatePlanesAndHolding(const Sequence& sequence,
                                          const std::vector<SegmentView>& views,
                                          const std::vector<std::optional<ShapePrior>>& priors,
                                          const PlanesOptions& options, int threads);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "initialisation/semantic_table.h"
#include "model/sequence.h"
#include "planes/options.h"
#include "planes/planes_estimate.h"
#include "planes/verticals.h"

namespace soslam {

struct HeldPlanes {
  PlanesEstimate estimate;
  Sequence level;  // its frames' poses have the same up everywhere
};

// EstimatePlanes for cameras that are held in any of kCameraHoldings: the most probable one's.
// `views`: by frame, with the segments in which verticals are looked for; empty where they are not.
HeldPlanes EstimateHeldPlanes(const Sequence& sequence, const std::vector<SegmentView>& views,
                              const std::vector<std::optional<ShapePrior>>& priors,
                              const PlanesOptions& options, int threads);

}  // namespace soslam

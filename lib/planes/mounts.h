// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "initialisation/semantic_table.h"
#include "planes/planes_estimate.h"
#include "planes/up_prior.h"

namespace soslam {

// Mount of an object with this prior; standing if it has none.
Mount MountOf(const std::optional<ShapePrior>& prior);

// Attitude for hanging objects, whose z axes point down. Ceilings are parallel to floors, if there
// are any.
UpPrior DownOf(const UpPrior& attitude, const std::optional<PlanesEstimate>& floors);

// Floors and ceilings in one estimate, with the objects of each on their own planes; ceilings are
// made parallel to the floor if `parallel`.
PlanesEstimate JoinedPlanes(const PlanesEstimate& floors, const PlanesEstimate& ceilings,
                            bool parallel, const std::vector<std::optional<ShapePrior>>& priors);

}  // namespace soslam

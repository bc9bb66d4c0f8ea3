// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "initialisation/semantic_table.h"
#include "model/sequence.h"
#include "planes/camera_attitude.h"
#include "planes/options.h"
#include "planes/planes_estimate.h"

namespace soslam {

// The planes that the sequence's objects stand on, upright, from their boxes in several frames, the
// trajectory, the objects' priors and what is known about up. Throws NothingUsableError when no
// object's views determine the height of its foot (one view, or all from the same place).
PlanesEstimate EstimatePlanes(const Sequence& sequence,
                              const std::vector<std::optional<ShapePrior>>& priors,
                              const CameraAttitude& attitude, const PlanesOptions& options,
                              int threads);

}  // namespace soslam

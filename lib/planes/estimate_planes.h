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

// What the boxes of objects cost, and what their noise alone would make of it.
struct BodyCosts {
  std::vector<std::optional<double>> of_objects;  // none: they are of no body
  double expected = 0.0;
};

// With an upright body of any height for each object, in the direction of up, of those that the
// attitude leaves open, that is best for all.
BodyCosts CostsOfUprightBodies(const Sequence& sequence,
                               const std::vector<std::optional<ShapePrior>>& priors,
                               const CameraAttitude& attitude, const PlanesOptions& options,
                               int threads);

// NothingUsableError: no object's views determine the height of its foot.
[[noreturn]] void ThrowNoPlanes(const Sequence& sequence);

// EstimatePlanes, or none when no object's views determine the height of its foot.
std::optional<PlanesEstimate> FindPlanes(const Sequence& sequence,
                                         const std::vector<std::optional<ShapePrior>>& priors,
                                         const CameraAttitude& attitude,
                                         const PlanesOptions& options, int threads);

// The planes that the sequence's objects stand on, upright, from their boxes in several frames, the
// trajectory, the objects' priors and what is known about up. Throws NothingUsableError when no
// object's views determine the height of its foot (one view, or all from the same place).
PlanesEstimate EstimatePlanes(const Sequence& sequence,
                              const std::vector<std::optional<ShapePrior>>& priors,
                              const CameraAttitude& attitude, const PlanesOptions& options,
                              int threads);

}  // namespace soslam

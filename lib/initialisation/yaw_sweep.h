// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "initialisation/object_points.h"
#include "initialisation/upright_options.h"
#include "model/estimates.h"
#include "model/sequence.h"
#include "model/shape_prior.h"

namespace soslam {

// Upright landmarks of any shape exponents for all detections: all hypotheses of FitObject, lowest
// cost first. `yaw_priors`: one per detection, or empty. `points`: none if null.
// Failures: no_ratio_for_label, fewer_than_three_measured_edges, no_solution.
LandmarkEstimates InitialiseUpright(const Sequence& sequence,
                                    const std::vector<std::optional<ShapePrior>>& priors,
                                    const UprightOptions& options, int threads,
                                    const std::vector<std::optional<YawPrior>>& yaw_priors = {},
                                    const PointsInFrames* points = nullptr);

}  // namespace soslam

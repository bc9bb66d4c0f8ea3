// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "mapping/back_end.h"
#include "mapping/options.h"
#include "model/estimates.h"
#include "model/sequence.h"

namespace soslam {

// A start for each object: of all hypotheses of all of its observations, the one that fits all of
// the object's boxes best (median over its observations of OutlineEdgeRms), seen from the frames'
// estimated poses: other views tell apart what explains one box equally well. Or the landmark that
// was estimated from all observations (SVD). Ellipsoids, whatever shape they were found with.
std::vector<std::optional<Landmark>> ChooseStarts(const Sequence& sequence,
                                                  const LandmarkEstimates& estimates);

// The same for upright bodies, where single frames disagree: of the hypotheses of all observations,
// the estimates from several views, and the optima of SweepViews, the best of every few degrees of
// yaw is fitted to the boxes, edges and ratio prior of views spread over the whole sequence, camera
// poses held, and the one of lowest cost is taken; where there are symmetry images, with what the
// texture of these views says. `input.starts` is not used.
std::vector<std::optional<Landmark>> ChooseUprightStarts(const BackEndInput& input,
                                                         const LandmarkEstimates& estimates,
                                                         const OptimiseOptions& options,
                                                         int threads);

}  // namespace soslam

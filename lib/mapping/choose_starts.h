// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "initialisation/semantic_table.h"
#include "mapping/options.h"
#include "model/estimates.h"
#include "model/sequence.h"
#include "orientation/edge_alignment.h"

namespace soslam {

// A start for each object: of all hypotheses of all of its observations, the one that fits all of
// the object's boxes best (median over its observations of OutlineEdgeRms), seen from the frames'
// estimated poses: other views tell apart what explains one box equally well. Or the landmark that
// was estimated from all observations (SVD).
std::vector<std::optional<Landmark>> ChooseStarts(const Sequence& sequence,
                                                  const LandmarkEstimates& estimates);

// The same for upright bodies, where single frames disagree: of the hypotheses of all observations
// the best of every few degrees of yaw is fitted to the boxes, edges and ratio prior of views
// spread over the whole sequence, camera poses held, and the one of lowest cost is taken.
// `edge_images` by index into Sequence::detections; may be empty.
std::vector<std::optional<Landmark>> ChooseUprightStarts(
    const Sequence& sequence, const LandmarkEstimates& estimates,
    const std::vector<std::optional<ShapePrior>>& priors,
    const std::map<int, std::shared_ptr<const EdgeImage>>& edge_images,
    const OptimiseOptions& options);

}  // namespace soslam

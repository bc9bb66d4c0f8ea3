// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "soslam/mapping/back_end.h"
#include "soslam/mapping/options.h"
#include "soslam/model/estimates.h"
#include "soslam/model/sequence.h"

namespace soslam {

// Landmarks of all hypotheses of the observations, in the world with the frames' estimated poses,
// by object.
std::vector<std::vector<Landmark>> HypothesesByObject(const Sequence& sequence,
                                                      const LandmarkEstimates& estimates);

// An initial landmark for each object: of the hypotheses of its observations, the one that fits all
// of the object's boxes best (median over its observations of OutlineEdgeRms), with the frames'
// estimated poses, because other views distinguish hypotheses that fit one box equally well; or the
// landmark that was estimated from all observations (SVD). Ellipsoids, whatever shape they were
// found with.
std::vector<std::optional<Landmark>> ChooseInitialLandmarks(const Sequence& sequence,
                                                            const LandmarkEstimates& estimates);

// Initial landmarks of upright bodies. Of the hypotheses of all observations, estimates from
// several views, and the minima of ProfileOverYaw, the best of every few degrees of yaw is fitted
// to the boxes, edges and ratio prior of views spread over the whole sequence, with constant poses;
// the one of lowest cost is taken, which with symmetry images includes the texture of these views.
// `input.initial_landmarks` may be empty and is not used. Throws InputError as CheckBackEndInput.
std::vector<std::optional<Landmark>> ChooseInitialUprightLandmarks(
    const BackEndInput& input, const LandmarkEstimates& estimates, const OptimiseOptions& options,
    int threads);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "initialisation/semantic_table.h"
#include "model/estimates.h"
#include "model/finding.h"
#include "model/sequence.h"
#include "planes/planes_estimate.h"

namespace soslam {

// What results say about themselves, without ground truth: whether they are to be trusted.

// Tries that gave no landmark, when they are more than a third; those of moving objects do not
// count.
std::vector<Finding> CheckFailures(const LandmarkEstimates& estimates);

// The heights of landmarks against what their labels allow: one factor for all, as a wrong scale
// gives, or single objects that are a multiple. The table's labels without a height do not count.
std::vector<Finding> CheckSizes(const LandmarkEstimates& estimates, const Sequence& sequence,
                                const SemanticTable& table);

// The landmarks of objects that are flat or needles, as views alone make them that do not determine
// all axes. Which of these is the height they do not say.
std::vector<Finding> CheckDegenerate(const LandmarkEstimates& estimates);
// Landmarks that shrank to a point.
std::vector<Finding> CheckCollapsed(const LandmarkEstimates& estimates);

// The cost that is left of boxes whose edges have a standard deviation, against what such boxes
// leave by chance.
std::vector<Finding> CheckCost(const SolverSummary& solver);

// Estimated planes, when they are nearly as many as the objects on them.
std::vector<Finding> CheckPlaneCount(size_t planes, size_t objects);

// How cameras are held, and so what is up, where other ways are about as probable and leave up open
// by `tilt_variance`.
std::vector<Finding> CheckUp(CameraHolding holding, const std::vector<TriedHolding>& holdings,
                             double tilt_variance);

}  // namespace soslam

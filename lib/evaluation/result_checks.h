// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "initialisation/semantic_table.h"
#include "model/estimates.h"
#include "model/finding.h"
#include "model/sequence.h"

namespace soslam {

// What results say about themselves, without ground truth: whether they are to be trusted.

// Tries that gave no landmark, when they are more than a third.
std::vector<Finding> CheckFailures(const LandmarkEstimates& estimates);

// The heights of landmarks against what their labels allow: one factor for all, as a wrong scale
// gives, or single objects that are a multiple. The table's labels without a height do not count.
std::vector<Finding> CheckSizes(const LandmarkEstimates& estimates, const Sequence& sequence,
                                const SemanticTable& table);

// The cost that is left of boxes whose edges have a standard deviation, against what such boxes
// leave by chance.
std::vector<Finding> CheckCost(const SolverSummary& solver);

// Estimated planes, when they are nearly as many as the objects on them.
std::vector<Finding> CheckPlaneCount(size_t planes, size_t objects);

}  // namespace soslam

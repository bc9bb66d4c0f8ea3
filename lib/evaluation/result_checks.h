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

// Whether support planes and ratios tell sizes, or views alone, which mostly cannot.
enum class SizesFrom { kSupport, kViews };

// The heights of landmarks against what their labels allow: one factor for all, as a wrong scale
// gives (with kSupport), or single objects that are a multiple. The table's labels without a height
// do not count.
std::vector<Finding> CheckSizes(const LandmarkEstimates& estimates, const Sequence& sequence,
                                const SemanticTable& table, SizesFrom sizes_from);

// The cost that is left of boxes whose edges have a standard deviation, against what such boxes
// leave by chance.
std::vector<Finding> CheckCost(const SolverSummary& solver);

// Estimated planes, when they are nearly as many as the objects on them.
std::vector<Finding> CheckPlaneCount(size_t planes, size_t objects);

// How cameras are held, and so what is up, where other ways are about as probable.
std::vector<Finding> CheckUp(const PlanesEstimate& estimate);

}  // namespace soslam

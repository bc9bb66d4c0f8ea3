// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <vector>

#include "model/sequence.h"

namespace soslam {

// The exponent in [1, 2] for which the true pose and size of an object fit its boxes best: least
// Huber loss of the tangency residuals, at true camera poses if they are known. `detections` are of
// one object, or of several of the same shape, with ground truth.
double BestShapeExponent(const Sequence& sequence, const std::vector<int>& detections);

// That exponent for each object with ground truth and at least `min_views` such boxes, by object
// index.
std::map<int, double> LearnShapeExponents(const Sequence& sequence, int min_views);

}  // namespace soslam

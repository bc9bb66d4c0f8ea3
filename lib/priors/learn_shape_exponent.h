// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <vector>

#include "model/sequence.h"

namespace soslam {

// The exponent in [1, 2] with which the true body of an object agrees best with its boxes: least
// Huber loss of the tangency residuals, poses true where known. `detections` are of one object, or
// of several of one shape, that have ground truth.
double BestShapeExponent(const Sequence& sequence, const std::vector<int>& detections);

// That of each object that has ground truth and at least `min_views` such boxes, by object index.
std::map<int, double> LearnShapeExponents(const Sequence& sequence, int min_views);

}  // namespace soslam

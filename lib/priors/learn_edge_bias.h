// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "initialisation/semantic_table.h"
#include "model/sequence.h"

namespace soslam {

// Learns the bias of a detector's box edges for each row of a table that has objects with ground
// truth in the sequences. Edges that are no bounds are compared with the outline of the object at
// its true pose and size, with the row's shape. The errors of an object's boxes are alike: it
// counts once, by their median. `no_bias_weight` objects without bias are added to those of each
// row. Method: docs/priors.md.
void LearnEdgeBias(const std::vector<Sequence>& sequences, double no_bias_weight,
                   SemanticRows* rows);

}  // namespace soslam

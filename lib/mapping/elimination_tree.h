// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "mapping/symmetric_blocks.h"

namespace soslam {

// Variables that are eliminated together, and the later ones that they are coupled with then.
struct EliminationGroup {
  int parent = -1;              // the group of the first neighbour; -1 without neighbours
  std::vector<int> pivots;      // in the order of elimination
  std::vector<int> neighbours;  // in the order of elimination
};

// The groups in the order of elimination, children before their parents and right before them with
// all that is below them. The order is Amestoy, Davis and Duff's approximate minimum degree; groups
// are merged where work in one larger dense matrix costs less than in two.
std::vector<EliminationGroup> EliminationTree(const SymmetricBlocks& pattern);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "dataset/import_options.h"
#include "model/sequence.h"

namespace soslam {

// Decides Detection::is_bound of every detection: an edge is a bound where the image border cuts
// the box, the lower edge also where its nearer_boxes hide it (hidden_edge_fraction).
void MarkBoundEdges(const ImportOptions& options, Sequence* sequence);

}  // namespace soslam

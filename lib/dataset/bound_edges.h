// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "dataset/import_options.h"
#include "model/sequence.h"

namespace soslam {

// Detection::is_bound says which edges of a box are bounds: those that the image border cuts, and a
// lower edge that nearer objects hide.

// The edges of a box that end at the border of the image it is in: left, top, right, bottom.
std::array<bool, 4> EdgesCutByBorder(const Box& box, const Camera& camera);

// Marks the lower edges that BoxesInFront hide (hidden_edge_fraction).
void MarkHiddenEdges(const ImportOptions& options, Sequence* sequence);

}  // namespace soslam

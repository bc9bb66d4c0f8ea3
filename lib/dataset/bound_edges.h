// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "dataset/import_options.h"
#include "model/sequence.h"

namespace soslam {

// Marks edges of boxes that are only bounds (Detection::is_bound): edges cut by the image border,
// and lower edges occluded by nearer objects.

// True for the edges of a box (left, top, right, bottom) at the border of its image.
std::array<bool, 4> EdgesCutByBorder(const Box& box, const Camera& camera);

// Marks lower edges that BoxesInFront cover (hidden_edge_fraction).
void MarkHiddenEdges(const ImportOptions& options, Sequence* sequence);

}  // namespace soslam

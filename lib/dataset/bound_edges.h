// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "dataset/import_options.h"
#include "model/sequence.h"

namespace soslam {

// Decides Detection::is_bound of every detection: an edge is a bound where the image border cuts
// the box, the lower edge also where boxes of nearer objects hide it (hidden_edge_fraction). What
// hides are the detections of `in_view`: the same frames and objects, but also boxes that are real
// and yet not used, such as those too close to the border.
void MarkBoundEdges(const ImportOptions& options, const Sequence& in_view, Sequence* sequence);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "association/options.h"
#include "initialisation/semantic_table.h"
#include "model/sequence.h"

namespace soslam {

// A sequence of which no plane is known, on one rough horizontal plane for each segment, good
// enough to link boxes on: up is as cameras are held (AttitudeOf), and the plane is at the height
// that gives objects the height of their label, by the median over the detections, each weighted by
// how sure its label is. Throws NothingUsableError when a segment has no detection of a label whose
// height the table knows.
Sequence OnProvisionalPlanes(Sequence sequence, const SemanticTable& table,
                             const AssociateOptions& options);

// The same sequence with no plane known.
Sequence WithoutPlanes(Sequence sequence);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "initialisation/point_term.h"
#include "initialisation/semantic_table.h"
#include "model/sequence.h"
#include "orientation/edge_alignment.h"
#include "orientation/options.h"
#include "orientation/refine_symmetry.h"

namespace soslam {

// Estimates the landmark of one detection from its orientation profile. At each yaw of a sweep,
// box, ratio prior, image edges and points, if there are any, together determine the best landmark
// and its cost; the symmetry of the texture on that landmark's surface is added. The best minima
// become the hypotheses, with their costs; the curves of all parts, the yaw and its standard
// deviation go into the record.
// Failures: no_ratio_for_label, fewer_than_three_measured_edges, no_solution.
RefinedObservation RefineOrientation(const Sequence& sequence, int detection_index,
                                     const std::shared_ptr<const FrameEdges>& edges,
                                     const std::optional<ShapePrior>& prior,
                                     const ProfileOptions& options,
                                     const SymmetryOptions& symmetry_options,
                                     const std::optional<PointEvidence>& points = std::nullopt);

}  // namespace soslam

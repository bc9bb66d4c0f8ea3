// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "soslam/constraints/point_cost.h"
#include "soslam/model/sequence.h"
#include "soslam/model/shape_prior.h"
#include "soslam/orientation/edge_alignment.h"
#include "soslam/orientation/options.h"
#include "soslam/orientation/refine_by_turning.h"

namespace soslam {

// Estimates the landmark of one detection from its orientation profile. At each yaw of a sweep,
// box, ratio prior, image edges and points, if there are any, together determine the best landmark
// and its cost; the symmetry of the texture on that landmark's surface is added. The best minima
// become the hypotheses, with their costs; the curves of all parts, the yaw and its standard
// deviation go into the record.
// Failures: no_ratio_for_label, fewer_than_three_measured_edges, no_solution.
RefinedObservation RefineByProfile(const Sequence& sequence, int detection_index,
                                   const std::shared_ptr<const FrameEdges>& edges,
                                   const std::optional<ShapePrior>& prior,
                                   const ProfileOptions& options,
                                   const SymmetryOptions& symmetry_options,
                                   const std::optional<PointEvidence>& points = std::nullopt);

// Number of vertical planes in which a texture is symmetric, from its TextureAsymmetry::Cost over a
// grid of yaws (rad, half a turn): 2 if it is low at `yaw` and a quarter turn from it, 1 if low at
// `yaw` alone, else 0. None if too few pairs are visible to decide, where the cost is options'
// asymmetry_cost.
std::optional<int> MirrorPlanes(const std::vector<double>& grid,
                                const std::vector<double>& texture_cost, double yaw,
                                const TextureOptions& options);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "constraints/point_term.h"
#include "image/edge_maps.h"
#include "model/estimates.h"
#include "model/sequence.h"
#include "model/shape_prior.h"
#include "orientation/edge_alignment.h"
#include "orientation/options.h"

namespace soslam {

struct RefinedObservation {
  ObservationEstimate estimate;  // the refined landmark in place of the hypotheses
  SymmetryRecord
      record;  // of the landmark before refinement: the cost over yaw of every descriptor, fig. 7
};

// The yaw of a detection's object in the camera frame, from ground truth; none without ground
// truth.
std::optional<double> TrueYaw(const Sequence& sequence, const Detection& detection);

// Refines the yaw of an observation's landmark by the symmetry of its texture, section V; centre
// and half axes stay. Of the hypotheses that fit the box equally well, the one with the lowest
// symmetry cost near its yaw is taken. If there is no such cost, the estimate stays unchanged, with
// the reason in `failure`: no_edges, too_few_visible_pairs, no_ratio_for_label. `ratio` is the (a /
// c, b / c) of eq. (11).
RefinedObservation RefineObservation(const Sequence& sequence, const ObservationEstimate& initial,
                                     const EdgeMaps& maps,
                                     const std::optional<Eigen::Vector2d>& ratio,
                                     const RefineOptions& options);

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

// Number of vertical planes in which a texture is symmetric, from its TextureAsymmetry::Cost over a
// grid of yaws (rad, half a turn): 2 if it is low at `yaw` and a quarter turn from it, 1 if low at
// `yaw` alone, else 0. None if too few pairs are visible to decide, where the cost is options'
// asymmetry_cost.
std::optional<int> MirrorPlanes(const std::vector<double>& grid,
                                const std::vector<double>& texture_cost, double yaw,
                                const TextureOptions& options);

}  // namespace soslam

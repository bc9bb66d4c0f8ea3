// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

#include "image/edge_maps.h"
#include "model/estimates.h"
#include "model/sequence.h"
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
RefinedObservation RefineByTurning(const Sequence& sequence, const ObservationEstimate& initial,
                                   const EdgeMaps& maps,
                                   const std::optional<Eigen::Vector2d>& ratio,
                                   const RefineOptions& options);

}  // namespace soslam

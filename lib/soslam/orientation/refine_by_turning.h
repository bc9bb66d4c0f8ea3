// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "soslam/geometry/camera.h"
#include "soslam/geometry/landmark.h"
#include "soslam/image/edge_maps.h"
#include "soslam/model/estimates.h"
#include "soslam/model/sequence.h"
#include "soslam/orientation/options.h"
#include "soslam/orientation/symmetry.h"

namespace soslam {

struct RefinedObservation {
  ObservationEstimate estimate;  // the refined landmark in place of the hypotheses
  SymmetryRecord
      record;  // of the landmark before refinement: the cost over yaw of every descriptor, fig. 7
};

// The symmetry cost of a landmark, eq. (16) under a robust kernel in its linear part: the mean of
// the absolute descriptor difference (unit of the descriptor) over the pairs of visible points.
// Absolute, because pairs for which the approximation of eq. (20) fails are few outliers; a mean,
// because the number of visible pairs depends on the yaw. None when there are fewer pairs than the
// options require. One cost for each descriptor, of which there is at least one.
std::vector<std::optional<double>> SymmetryCosts(const SymmetryImage& image, const Camera& camera,
                                                 const Landmark& landmark_in_camera,
                                                 const std::vector<Eigen::Vector2d>& samples,
                                                 const std::vector<Descriptor>& descriptors,
                                                 const SymmetryOptions& options);

// Adds the pair of a pixel to what is recorded, if there is one.
void RecordPair(const Eigen::Vector2d& pixel, const std::optional<SymmetryDescriptor::Pair>& pair,
                SymmetryRecord* record);

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

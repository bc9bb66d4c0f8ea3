// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "constraints/symmetry.h"
#include "initialisation/semantic_table.h"
#include "mapping/options.h"
#include "model/estimates.h"
#include "model/sequence.h"
#include "orientation/edge_alignment.h"

namespace soslam {

// What the back end works on.
struct BackEndInput {
  const Sequence& sequence;
  // One per object of the sequence, in the world frame of Frame::world_from_camera; none where an
  // object has no start, which leaves it out.
  std::vector<std::optional<Landmark>> starts;
  // What is known of each object's ratio; none leaves out its ratio constraint.
  std::vector<std::optional<ShapePrior>> priors;
  // Images of the observations whose texture symmetry has a cost, by index into
  // Sequence::detections.
  std::map<int, std::shared_ptr<const SymmetryImage>> symmetry_images;
  // Images of the observations whose edges are aligned, by index into Sequence::detections.
  std::map<int, std::shared_ptr<const EdgeImage>> edge_images;
};

// Eq. (1): the camera poses and landmarks that minimise detection, odometry, support, ratio,
// symmetry and edge costs, from the odometry's poses and the given starts. Under a Huber loss all
// of them with detection_model quadric; with tangency those of odometry and boxes, as texture and
// edges are bounded by themselves and the rest is no outlier. The first pose of each segment is
// fixed: it defines the segment's world; with hold_poses all are, and odometry has no cost. Objects
// without a start come back with the failure no_start, moving ones with moving, and those without
// HasExtent in the end with collapsed. The result does not depend on the number of threads. Throws
// NumericalError when the solver has no usable solution.
MapEstimate OptimiseMap(const BackEndInput& input, const OptimiseOptions& options, int threads = 1);

}  // namespace soslam

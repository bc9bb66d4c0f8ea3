// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "constraints/symmetry.h"
#include "mapping/options.h"
#include "model/estimates.h"
#include "model/sequence.h"

namespace soslam {

// What the back end works on.
struct BackEndInput {
  const Sequence& sequence;
  // One per object of the sequence, in the world frame of Frame::world_from_camera; none where an
  // object has no start, which leaves it out.
  std::vector<std::optional<Landmark>> starts;
  // The (a / c, b / c) of each object; none leaves out its ratio constraint.
  std::vector<std::optional<Eigen::Vector2d>> ratios;
  // By index into Sequence::detections: the observations whose texture symmetry counts.
  std::map<int, std::shared_ptr<const SymmetryImage>> symmetry_images;
};

// Eq. (1): the camera poses and landmarks that minimise detection, odometry, support, ratio and
// symmetry costs under a Huber loss, from the odometry's poses and the given starts. The first pose
// is fixed: it defines the world. Objects without a start come back with the failure no_start.
// Throws NumericalError when the solver has no usable solution.
MapEstimate OptimiseMap(const BackEndInput& input, const OptimiseOptions& options);

// A start for each object: of all hypotheses of all of its observations, the one that fits all of
// the object's boxes best (median over its observations of OutlineEdgeRms), seen from the frames'
// estimated poses: other views tell apart what explains one box equally well. Or the landmark that
// was estimated from all observations (SVD).
std::vector<std::optional<Landmark>> ChooseStarts(const Sequence& sequence,
                                                  const LandmarkEstimates& estimates);

}  // namespace soslam

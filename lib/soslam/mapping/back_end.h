// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "soslam/constraints/image_evidence.h"
#include "soslam/initialisation/object_points.h"
#include "soslam/mapping/options.h"
#include "soslam/model/estimates.h"
#include "soslam/model/sequence.h"
#include "soslam/model/shape_prior.h"

namespace soslam {

// Images as evidence, each for the detection of this index in Sequence::detections.
using EvidenceOfImages = std::vector<std::pair<int, std::shared_ptr<const ImageEvidence>>>;

// Input of the back end.
struct BackEndInput {
  const Sequence& sequence;
  // Initial landmarks, one per object of the sequence, in the world frame of
  // Frame::world_from_camera. Objects without one are left out.
  std::vector<std::optional<Landmark>> initial_landmarks;
  // Prior of each object's ratio as it stands. Without one it has no ratio constraint, and is a
  // cuboid where bodies have any shape.
  std::vector<std::optional<ShapePrior>> priors;
  EvidenceOfImages images = {};
  // Points of each object (FindObjectPoints); empty: none are used.
  std::vector<PointsOfObject> points = {};
  // Landmarks in the world that say how much each image weighs, so that the costs of several
  // solutions can be compared; empty: those of each solution.
  std::vector<std::optional<Landmark>> images_weighed_at = {};
};

// Eq. (1): the camera poses and landmarks that minimise detection, odometry, support, ratio,
// symmetry and edge costs, beginning at the odometry's poses and the initial landmarks. With
// detection_model quadric, all costs have a Huber loss; with tangency, those of odometry and boxes
// do: texture, edges and points are bounded, and the others have no outliers. The first pose of
// each segment is constant, as it defines the segment's world; with hold_poses all are, and
// odometry has no cost. Objects fail with no_start without an initial landmark, with moving if they
// move, and with collapsed if their landmark ends without HasExtent. The result does not depend on
// the number of threads. Throws InputError as the checks of check_input.h, NumericalError
// when the solver has no usable solution.
MapEstimate OptimiseMap(const BackEndInput& input, const OptimiseOptions& options, int threads = 1);

// One object at the minimum of the back end's cost near a start, with all else constant.
struct OptimisedObject {
  Landmark landmark_in_world;
  double cost;
  double cost_of_start;  // without images
};

// The object's minimum near `start`, with the poses and planes of the input's sequence; its initial
// landmarks only say how much images weigh. Does not check the input. None if there is no minimum.
std::optional<OptimisedObject> OptimiseObject(const BackEndInput& input, size_t object_index,
                                              const Landmark& start,
                                              const OptimiseOptions& options);

}  // namespace soslam

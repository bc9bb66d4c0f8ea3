// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "dataset/dataset_checks.h"

namespace soslam {

// The middle of a box, as a viewing ray of a frame.
struct TrackedRay {
  size_t frame = 0;  // into DatasetContent::frames
  Eigen::Vector3d ray_in_camera;
  double half_diagonal_deg = 0.0;  // of the box
};

// A thing of which several boxes are known.
struct TrackedThing {
  std::optional<int> object_id;  // none: the only thing with its label
  std::vector<TrackedRay> rays;
};

// The things that an object id or, without ids, a label that no frame has twice tells apart. Boxes
// that the image cuts do not count, nor those below min_score, of moving objects, and of things
// with fewer than three others.
std::vector<TrackedThing> TrackedThings(const ImportView& view);

// The pose of a frame, by index into DatasetContent::frames; none where there is none.
using PoseOfFrame = std::function<std::optional<Rigid3d>(size_t frame)>;

// The point that is nearest to the rays of a thing from these poses (least squares); none where the
// rays are too few or too parallel to meet.
std::optional<Eigen::Vector3d> NearestPointInWorld(const std::vector<TrackedRay>& rays,
                                                   const PoseOfFrame& world_from_camera);

// How far things are from where they are seen, each at its nearest point: what poses and boxes
// disagree by.
struct RayError {
  double median_deg = 0.0;
  double median_share = 0.0;  // of the half diagonals of the boxes
  size_t rays = 0;            // of the things that have such a point
  size_t things = 0;
};
// None when no thing has such a point.
std::optional<RayError> MedianRayError(const std::vector<TrackedThing>& things,
                                       const PoseOfFrame& world_from_camera);

}  // namespace soslam

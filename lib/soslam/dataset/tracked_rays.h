// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "soslam/dataset/dataset_checks.h"
#include "soslam/geometry/rigid3.h"

namespace soslam {

// Viewing ray through the centre of a box.
struct TrackedRay {
  size_t frame = 0;  // index in DatasetContent::frames
  Eigen::Vector3d ray_in_camera;
  double half_diagonal_deg = 0.0;  // of the box
};

// An object seen in several boxes.
struct TrackedObject {
  std::optional<int> object_id;  // none: the only object with its label
  std::vector<TrackedRay> rays;
};

// Objects that are identified by object id or, without ids, by a label that occurs at most once per
// frame. Without boxes that the image cuts or below min_score, moving objects, and objects with
// fewer than four boxes.
std::vector<TrackedObject> TrackedObjects(const ImportView& view);

// Pose of a frame, by index in DatasetContent::frames; none where there is none.
using PoseOfFrame = std::function<std::optional<Rigid3d>(size_t frame)>;
// Pose of another frame in the list, if there is one of the same segment.
std::optional<Rigid3d> PoseOfOther(const ImportView& view, size_t frame, size_t other);

// Triangulates the point nearest to the rays of an object from these poses (least squares); none
// where the rays are too few or too parallel.
std::optional<Eigen::Vector3d> NearestPointInWorld(const std::vector<TrackedRay>& rays,
                                                   const PoseOfFrame& world_from_camera);

// Disagreement of poses and boxes: angles between rays and triangulated points.
struct RayError {
  double median_deg = 0.0;
  double median_share = 0.0;  // relative to the half diagonals of the boxes
  size_t rays = 0;            // of the objects with a triangulated point
  size_t objects = 0;         // with such a point
};
// Median error over all objects; none when no object can be triangulated.
std::optional<RayError> MedianRayError(const std::vector<TrackedObject>& objects,
                                       const PoseOfFrame& world_from_camera);
// True if an error is from about the same number of rays.
bool IsComparable(const std::optional<RayError>& error, const RayError& as_read);

// Poses that are a constant time late or early, of which the seconds and the images are measured,
// or frames that are counted from 1: rays meet clearly better from the poses of other times.
std::vector<Finding> CheckLag(const ImportView& view, const std::vector<TrackedObject>& objects,
                              const RayError& as_read);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "dataset/dataset_checks.h"

namespace soslam {

// The middle of a box of a tracked thing, as a viewing ray of a frame.
struct TrackedRay {
  size_t frame = 0;  // into DatasetContent::frames
  Eigen::Vector3d ray_in_camera;
};

// The rays of each thing of which several boxes are known: those of an object id, or else those of
// a label that no frame has twice. Boxes that the image cuts do not count, nor things with fewer
// than three others.
std::vector<std::vector<TrackedRay>> TrackedRays(const ImportView& view);

// The pose of a frame, by index into DatasetContent::frames; none where there is none.
using PoseOfFrame = std::function<std::optional<Rigid3d>(size_t frame)>;

// The point that is nearest to the rays of a thing from these poses (least squares); none where the
// rays are too few or too parallel to meet.
std::optional<Eigen::Vector3d> NearestPointInWorld(const std::vector<TrackedRay>& rays,
                                                   const PoseOfFrame& world_from_camera);

// How far (rad, median over all rays) things are from where they are seen, each at its nearest
// point: what poses and boxes disagree by. None when no thing has such a point.
std::optional<double> MedianRayError(const std::vector<std::vector<TrackedRay>>& things,
                                     const PoseOfFrame& world_from_camera);

}  // namespace soslam

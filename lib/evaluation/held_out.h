// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "model/estimates.h"
#include "model/sequence.h"

namespace soslam {

// How landmarks agree with what was detected in frames that they were not estimated from. In each
// of these the boxes of the landmarks' outlines and the detected ones are matched one to one, with
// equal labels, so that the sum of intersections over unions is largest; pairs below
// kMinHeldOutIou do not match.
inline constexpr double kMinHeldOutIou = 0.25;

// Of one landmark, over the held-out frames. It is in sight where its outline is wholly in the
// image, as far from the border as all detections are; hidden or not.
struct HeldOutObject {
  int object_index = 0;
  int in_sight = 0;
  int in_sight_matched = 0;
  int matched = 0;                 // in sight or not
  std::optional<double> iou_mean;  // over `matched`
};

struct HeldOutMetrics {
  int frames = 0;
  int detections = 0;
  int detections_matched = 0;
  int in_sight = 0;  // pairs of landmark and frame
  int in_sight_matched = 0;
  std::optional<double> iou_mean, iou_median;    // over matched pairs
  std::optional<double> iou_mean_of_detections;  // those that no landmark explains have 0
  std::vector<HeldOutObject> objects;            // those with a landmark
};

// `world_from_camera`: one per Sequence::held_out, in the landmarks' world. None without held-out
// frames, and for estimates without landmarks of objects.
std::optional<HeldOutMetrics> EvaluateHeldOut(const Sequence& sequence,
                                              const std::vector<ObjectEstimate>& estimates,
                                              const std::vector<Rigid3d>& world_from_camera);

// The poses of held-out frames in the world of a map, whose poses (one per Sequence::frames) the
// odometry leads to from the frame before, in the same segment.
std::vector<Rigid3d> HeldOutPoses(const Sequence& sequence,
                                  const std::vector<Rigid3d>& world_from_camera);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "model/estimates.h"
#include "model/sequence.h"

namespace soslam {

// Agreement of landmarks with detections in frames that were not used to estimate them. In each of
// these frames the outline boxes of the landmarks and the detected boxes are matched one to one,
// with equal labels, so that the sum of intersections over unions is maximal; pairs below
// kMinHeldOutIou do not match.
inline constexpr double kMinHeldOutIou = 0.25;

// Results of one landmark over the held-out frames. It is in sight if its outline is wholly in the
// image, as far from the border as all detections are; whether occluded or not.
struct HeldOutObject {
  int object_index = 0;
  int in_sight = 0;
  int in_sight_matched = 0;
  int matched = 0;                 // whether in sight or not
  std::optional<double> iou_mean;  // over `matched`
};

struct HeldOutMetrics {
  int frames = 0;
  int detections = 0;
  int detections_matched = 0;
  int in_sight = 0;  // pairs of landmark and frame
  int in_sight_matched = 0;
  std::optional<double> iou_mean, iou_median;    // over matched pairs
  std::optional<double> iou_mean_of_detections;  // 0 for those without a matching landmark
  std::vector<HeldOutObject> objects;            // only objects with a landmark
};

// `world_from_camera`: one per Sequence::held_out, in the landmarks' world. None without held-out
// frames, or if no landmarks of objects were estimated.
std::optional<HeldOutMetrics> EvaluateHeldOut(const Sequence& sequence,
                                              const std::vector<ObjectEstimate>& estimates,
                                              const std::vector<Rigid3d>& world_from_camera);

// The poses of held-out frames in the world of a map: odometry, continued from the map's pose of
// the previous frame in the same segment (of the next one if there is none). `world_from_camera`
// has one pose per Sequence::frames.
std::vector<Rigid3d> HeldOutPoses(const Sequence& sequence,
                                  const std::vector<Rigid3d>& world_from_camera);

}  // namespace soslam

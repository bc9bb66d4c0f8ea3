// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "soslam/model/sequence.h"

namespace soslam {

// Poses of true objects in the camera frames. If the dataset has the pose of an object for each
// frame, it is that, and the object is not seen in other frames. Otherwise it is the pose in the
// world, seen from the true camera pose, or without one from the odometry if that is in the world
// of the truth. It never depends on a map.
class TrueViews {
 public:
  // The sequence has to outlive it.
  explicit TrueViews(const Sequence& sequence);

  // Empty if unknown, as for an object that moves or is of another segment.
  std::optional<Landmark> InCamera(int frame_index, int true_index) const;
  // The true landmark, if it does not depend on the odometry.
  std::optional<Landmark> KnownInCamera(int frame_index, int true_index) const;

 private:
  const Sequence& sequence_;
  // Empty for an object that is not in the frame's world.
  std::optional<Landmark> FromPose(const Rigid3d& world_from_camera, int frame_index,
                                   const TrueObject& object) const;

  // True landmarks that have poses per frame, by id, by frame.
  std::map<int, std::map<int, const Landmark*>> of_frames_;
};

// A box, used or not, that belongs to a true object.
struct TrueView {
  int frame_index = 0;
  std::optional<int> detection_index = std::nullopt;  // into Sequence::detections,
  std::optional<int> rejected_index = std::nullopt;   // or Sequence::rejected
};

// A box overlaps a true object if its IoU with the object's outline box, cut to the image, is at
// least kMinViewIou. It belongs to the one with the largest IoU. Boxes with a score below
// kMinViewScore are ignored.
inline constexpr double kMinViewIou = 0.5;
inline constexpr double kMinViewScore = 0.25;
// An object is detectable when boxes overlap it in at least this many frames.
inline constexpr int kFewestViews = 3;

struct ViewsOfTruth {
  std::vector<std::vector<TrueView>> of_object;  // by Sequence::true_objects, frames ascending
  std::vector<int> detected_frames;              // number of frames with a box that overlaps it
  std::vector<std::optional<int>> object_of_detection;  // by Sequence::detections
};
ViewsOfTruth FindViews(const Sequence& sequence, const TrueViews& views);

}  // namespace soslam

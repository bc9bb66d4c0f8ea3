// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "geometry/landmark.h"

namespace soslam {

// Exact values of an object, for evaluation and as a prior where a setting asks for it. For a
// moving object, the landmark at its first observation.
struct GroundTruth {
  Landmark landmark_in_world;
  bool mirror_symmetric = true;
  bool mirror_symmetric_yz = false;
  bool rotationally_symmetric = false;
};

// An object known to exist in the scene, independent of detections and of their assignment to
// objects.
struct TrueObject {
  int id = 0;
  std::string label;
  GroundTruth truth;
  int segment = 0;        // segment whose world the landmark is in
  bool is_static = true;  // false: it has no place in a map
  // True if its label is not among those requested at import: a landmark of it is neither right nor
  // wrong, and a missing one is not a miss.
  bool is_ignored = false;

  bool IsWanted() const { return is_static && !is_ignored; }
};

// Exact pose of an object in one frame, also while it moves.
struct TruthInFrame {
  int frame_index = 0;     // index in Sequence::frames
  int true_object_id = 0;  // id in Sequence::true_objects
  Landmark landmark_in_camera;
};

// Objects that exist but were not measured: a landmark of them is neither right nor wrong.
struct IgnoredThings {
  std::optional<std::string> label;         // none: any label
  std::optional<Landmark> volume_in_world;  // none: anywhere
};

// World frame of the odometry, as the dataset's settings give it.
enum class OdometryWorld {
  kOfTruth,       // the frame of the true poses and objects, unless the data contradict
  kOwn,           // another frame, in metres
  kOwnWithScale,  // another frame, of any unit
};
inline constexpr const char* kOdometryWorldNames[] = {"of_truth", "own", "own_with_scale"};

}  // namespace soslam

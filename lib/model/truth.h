// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "geometry/landmark.h"

namespace soslam {

// Exact values of an object: for evaluation, and as a prior where a setting asks for it. Of an
// object that moves, the landmark is where it was seen first.
struct GroundTruth {
  Landmark landmark_in_world;
  bool mirror_symmetric = true;
  bool mirror_symmetric_yz = false;
  bool rotationally_symmetric = false;
};

// An object that is known to be there, whatever is detected of it, and whoever says which
// detections are of one object.
struct TrueObject {
  int id = 0;
  std::string label;
  GroundTruth truth;
  int segment = 0;        // whose world that is
  bool is_static = true;  // otherwise it has no place in a map
  // Its label is none of those that the import was asked for: a landmark of it is neither right nor
  // wrong, and that there is none is no miss.
  bool is_ignored = false;

  bool IsWanted() const { return is_static && !is_ignored; }
};

// Where a dataset says for each frame where an object is: exact, also while it moves.
struct TruthInFrame {
  int frame_index = 0;     // into Sequence::frames
  int true_object_id = 0;  // of Sequence::true_objects
  Landmark landmark_in_camera;
};

// Things that are there and that nobody has measured: a landmark of theirs is neither right nor
// wrong.
struct IgnoredThings {
  std::optional<std::string> label;         // none: whatever they are
  std::optional<Landmark> volume_in_world;  // none: wherever they are
};

// Whose world the odometry is in, as the dataset's settings say.
enum class OdometryWorld {
  kOfTruth,       // that of the true poses and objects, as far as nothing else shows
  kOwn,           // another one, in metres
  kOwnWithScale,  // another one, of any unit
};
inline constexpr const char* kOdometryWorldNames[] = {"of_truth", "own", "own_with_scale"};

}  // namespace soslam

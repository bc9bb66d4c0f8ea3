// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "model/sequence.h"

namespace soslam {

// What a detection is of, as its camera really saw it. The sequence has ground truth.
inline Landmark TrueLandmarkInCamera(const Sequence& sequence, const Detection& detection) {
  const auto& object = sequence.objects[static_cast<size_t>(detection.object_index)];
  const auto& frame = sequence.frames[static_cast<size_t>(detection.frame_index)];
  return Transform(frame.true_world_from_camera->Inverse(), object.ground_truth->landmark_in_world);
}

}  // namespace soslam

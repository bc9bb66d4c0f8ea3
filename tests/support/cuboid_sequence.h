// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "synthesis/random_scene.h"
#include "synthesis/simulate.h"

namespace soslam {

// Cuboids on a floor of any yaw that a robot drives past, with exact boxes and true poses.
inline Sequence CuboidSequence(int objects, int frames) {
  Sequence sequence = SyntheticSequence(RandomScene(5, objects, frames, {Shape::kBox}), false);
  for (Object& object : sequence.objects) {
    object.ground_truth->landmark_in_world.shape_exponent = kCuboidExponent;
  }
  return sequence;
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "soslam/model/estimates.h"
#include "soslam/model/sequence.h"

namespace soslam {

// The poses and planes of a sequence as a map of it, without objects.
inline MapEstimate EmptyMap(const Sequence& sequence) {
  MapEstimate map;
  map.world_from_camera = PosesOf(sequence);
  map.planes_in_world = PlanesOf(sequence);
  return map;
}

// The same with the true landmarks.
inline MapEstimate TrueMap(const Sequence& sequence) {
  MapEstimate map = EmptyMap(sequence);
  for (const Object& object : sequence.objects) {
    const int index = static_cast<int>(map.objects.size());
    map.objects.push_back({index, 3, object.ground_truth->landmark_in_world, {}, ""});
  }
  return map;
}

}  // namespace soslam

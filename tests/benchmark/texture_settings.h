// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "orientation/options.h"

namespace soslam {

// How pipelines/variants/InitST.json and OursST.json compare the texture of an observation.
inline SymmetryOptions SymmetryOfST() {
  SymmetryOptions options;
  options.sampling = Sampling::kEdges;
  options.descriptor = Descriptor::kDistanceTransform;
  options.min_viewing_cosine = 0.1;
  options.min_pair_fraction = 0.1;
  return options;
}
inline TextureOptions TextureOfST() {
  TextureOptions options;
  options.asymmetry_cost = 8.0;
  options.mirror_plane_range = 0.2;
  return options;
}

}  // namespace soslam

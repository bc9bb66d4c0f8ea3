// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "benchmark/inputs.h"
#include "benchmark/texture_settings.h"
#include "initialisation/initialise.h"
#include "mapping/back_end.h"

namespace soslam {

// Options of pipelines/variants/OursST.json, without covariances, which the paper does not compute.
inline OptimiseOptions OptionsOfOursST() {
  OptimiseOptions options;
  options.detection_model = DetectionModel::kTangency;
  options.odometry_rotation_sigma_deg = 0.1;
  options.odometry_translation_sigma_m = 0.003;
  options.symmetry_options = SymmetryOfST();
  options.texture = TextureOfST();
  options.covariances = false;
  return options;
}

// The back end's input for one object of a sequence: its start is the landmark of its first
// observation, and the texture of `textures` observations counts, evenly over all from the first
// on. With textures the sequence is TwelveViews().
struct OneObject {
  OneObject(const Sequence& all, size_t object_index, size_t textures);
  OneObject(const OneObject&) = delete;  // input refers to sequence

  // IoU of the result with the truth.
  double Iou(const MapEstimate& map) const;

  Sequence sequence;
  BackEndInput input;
};

}  // namespace soslam

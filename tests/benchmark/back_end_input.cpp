// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/back_end_input.h"

namespace soslam {

OneObject::OneObject(const Sequence& all, size_t object_index, size_t textures)
    : sequence(OnlyObject(all, object_index)), input{sequence, {}, TruePriors(sequence), {}, {}} {
  const Sequence first = FirstObservations(sequence);
  const auto estimates = InitialiseUpright(first, input.priors, UprightOptions(), /*threads=*/1);
  input.initial_landmarks = {FacingCamera(first, estimates.observations.front())};
  for (const int index : SpreadOver(DetectionsByObject(sequence).front(), textures)) {
    const Detection& detection = sequence.detections[static_cast<size_t>(index)];
    const auto& edges = EdgesOfTwelveViews()[static_cast<size_t>(detection.frame_index)];
    input.symmetry_images[index] =
        std::make_shared<const SymmetryImage>(edges->maps, detection.box);
  }
}

double OneObject::Iou(const MapEstimate& map) const {
  const auto& landmark = map.objects.front().landmark_in_world;
  return landmark ? MeanIou(sequence, {*landmark}) : 0.0;
}

}  // namespace soslam

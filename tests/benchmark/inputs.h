// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "soslam/mapping/back_end.h"
#include "soslam/model/estimates.h"
#include "soslam/model/semantic_table.h"
#include "soslam/model/sequence.h"
#include "soslam/orientation/edge_alignment.h"

namespace soslam {

// Six textured ellipsoids on a floor, their fronts roughly towards the camera, which moves along an
// arc of 60 degrees around them; all are in sight in all of twelve frames, as many observations of
// each object as in the paper's Table V. Boxes and odometry have noise.
const Sequence& TwelveViews();
// What edge detection finds in their rendered images, by frame; rendered once.
const std::vector<std::shared_ptr<const FrameEdges>>& EdgesOfTwelveViews();

// The sequence as if it had no other object: this one has index 0.
Sequence OnlyObject(const Sequence& sequence, size_t object_index);
// Without all detections but the first of each object.
Sequence FirstObservations(Sequence sequence);

// The landmark, in the world, of the hypothesis whose front is nearest to the world's x axis: what
// is known of these objects, as boxes alone are explained by several yaws.
Landmark FacingCamera(const Sequence& sequence, const ObservationEstimate& estimate);

// Each object's true ratio, good to a tenth, and its true shape.
std::vector<std::optional<ShapePrior>> TruePriors(const Sequence& sequence);

// The mean IoU of landmarks in the world, one per object of the sequence, with the truth.
double MeanIou(const Sequence& sequence, const std::vector<Landmark>& landmarks_in_world);

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
// on.
struct OneObject {
  OneObject(const Sequence& all, size_t object_index, size_t textures);
  OneObject(const OneObject&) = delete;  // input refers to sequence

  Sequence sequence;
  BackEndInput input;
};

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "initialisation/semantic_table.h"
#include "model/estimates.h"
#include "model/sequence.h"
#include "orientation/edge_alignment.h"
#include "synthesis/scene.h"

namespace soslam {

// Six textured ellipsoids on a floor, their fronts roughly towards the camera, which moves along an
// arc of 60 degrees around them; all are in sight in all frames. Boxes and odometry have noise.
Scene ArcScene(int frames);

// Twelve frames of that scene, as many observations of each object as in the paper's Table V.
const Sequence& TwelveViews();
// What edge detection finds in their rendered images, by frame; rendered once.
const std::vector<std::shared_ptr<const FrameEdges>>& EdgesOfTwelveViews();

// The sequence as if it had no other object: this one has index 0.
Sequence OnlyObject(const Sequence& sequence, size_t object_index);
// Without all detections but the first of each object.
Sequence FirstObservations(Sequence sequence);

// The landmark, in the world, of the hypothesis whose front is nearest to the world's x axis: what
// is known of the objects of ArcScene, as boxes alone are explained by several yaws.
Landmark FacingCamera(const Sequence& sequence, const ObservationEstimate& estimate);

// Each object's true ratio, good to a tenth, and its true shape.
std::vector<std::optional<ShapePrior>> TruePriors(const Sequence& sequence);

// The mean IoU of landmarks in the world, one per object of the sequence, with the truth.
double MeanIou(const Sequence& sequence, const std::vector<Landmark>& landmarks_in_world);

// data/room_a as the pipeline imports it, and the table of priors by label.
const Sequence& RoomA();
const SemanticTable& TableOfPriors();
// The first image of data/room_a: grey, 640 x 480 pixels.
cv::Mat RoomAImage();

}  // namespace soslam

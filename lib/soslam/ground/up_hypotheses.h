// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "soslam/association/edits.h"
#include "soslam/association/pair_evidence.h"
#include "soslam/association/up_estimate.h"
#include "soslam/ground/horizontal_planes.h"
#include "soslam/ground/object_heights.h"
#include "soslam/ground/options.h"
#include "soslam/ground/scale_posterior.h"
#include "soslam/model/image_turns.h"
#include "soslam/model/semantic_table.h"
#include "soslam/model/sequence.h"
#include "soslam/planes/up_prior.h"

namespace soslam {

// Scores of the detections in a frame's image and in its turned copies (ImageTurns::Row).
struct TurnedImage {
  int frame_index;
  std::array<double, kQuarterTurns> scores;
};

// KnownScale::setting of an object whose size edits give.
inline constexpr const char* kSizeByHand = "edits";

// The input of the estimate, in the normalised world.
struct NormalisedInput {
  const Sequence& sequence;
  const std::vector<GroundPoint>& points;
  const std::vector<TurnedImage>& turned_images;
  const FoundEdits& edits;
  const PairEvidence& pairs;
  const SemanticTable& table;
  const GroundOptions& options;
  double units_per_input;  // units of the input in a normalised one
  int threads;
};

// A way in which the cameras may be held, and what follows from it in the normalised world.
struct UpHypothesis {
  CameraOrientation orientation = CameraOrientation::kLevel;
  // Negative log likelihoods: of boxes alone, and with turned images and objects on planes.
  double cost_of_boxes = 0.0, cost = 0.0;
  UpPrior up_prior;  // from cameras and vertical edges
  UpPrior without_verticals;
  HorizontalPlanes planes;
  std::vector<MeasuredObject> objects;
  bool verticals = false;           // vertical edges were used
  bool cameras_are_turned = false;  // in many ways: only planes tell up
  int planes_of_points = 0;         // before planes without an object were dropped
  // Scale of the normalised world: by two options and measured objects, by all, by labels alone.
  std::vector<KnownScale> known_scales;
  std::optional<ScalePosterior> scale, scale_of_objects;

  // For each plane, the sum of the probabilities of objects to stand on it.
  std::vector<double> ObjectsOnPlanes() const;
  double StandingObjects() const;
};

// The most probable way to hold the cameras.
struct ChosenUp {
  UpHypothesis hypothesis;
  UpEstimate of_cameras;     // how they are held, and how probable other ways are
  double probability = 1.0;  // that up is within kTrustedUpDeg of the true one
};

// All ways to hold the cameras, compared by one sum: prior, boxes, turned images and objects that
// stand on planes of points. Cameras that are turned in many ways are the last one, where fewer
// than half of the objects stand in the best other one.
ChosenUp ChooseUp(const NormalisedInput& input, const UpEstimate& of_boxes,
                  const std::vector<SegmentView>& views);

}  // namespace soslam

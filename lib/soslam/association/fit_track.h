// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "soslam/association/options.h"
#include "soslam/association/up_estimate.h"
#include "soslam/geometry/landmark.h"
#include "soslam/model/estimates.h"
#include "soslam/model/sequence.h"
#include "soslam/model/shape_prior.h"

namespace soslam {

struct FittedObject {
  Landmark landmark_in_world;
  Covariance9 covariance;  // over the parameters of kLandmarkDof
  // -log of the probability of the boxes given prior and support (Laplace's approximation), up to a
  // constant that only depends on the boxes.
  double cost = 0.0;
  // The part of it that is not of boxes: prior, and volume of the posterior.
  double prior_cost = 0.0;
  double cost_of_misfit = 0.0;   // the part that is of boxes and prior at the landmark
  bool feet_are_hidden = false;  // behind something unknown, in most views
};

// Probabilities that something unknown hides the feet of an object, as a table those of its chairs,
// and that it does so in a view, if it does.
inline constexpr double kHiddenFeet = 0.1;
inline constexpr double kHiddenFeetInView = 0.5;

// The support of an object: a plane of the sequence or, where there is none, the direction of up
// alone.
struct Support {
  int plane_index = kNoPlane;
  std::variant<Plane, UpEstimate> in_world;
};

struct TrackFitOptions {
  // Where to start; empty: at the minima of the profile over yaw.
  std::vector<Landmark> starts = {};
  bool feet_may_be_hidden = true;
};

// Fits an object's landmark to its detections (indices in Sequence::detections, at least one), of
// which at most max_views are used, on the face that fits best, with or without hidden feet. The
// covariance is the inverse of the information of boxes and prior; views from one side count as
// one. None when the boxes do not determine a landmark in front of the cameras.
//
// An object without a plane is upright at a free height, and its prior's height_m fixes the scale
// and thus the distance. The covariance includes the uncertainty of up, with the landmark adapting
// to it.
std::optional<FittedObject> FitTrack(const Sequence& sequence, const std::vector<int>& detections,
                                     const ShapePrior& prior, const AssociateOptions& options,
                                     const std::variant<Plane, UpEstimate>& support_in_world,
                                     const TrackFitOptions& how = {});

// How well an object's boxes alone determine its body, on a support plane through its foot: the
// expected intersection over union of the body with one drawn from what the boxes leave possible.
// The sizes of its label do not count, and neither do one-sided edges, which limit a body but do
// not measure it. `prior` gives the bias of box edges. Random numbers are the same in each call.
double OverlapByBoxes(const Sequence& sequence, const std::vector<int>& detections,
                      const ShapePrior& prior, const AssociateOptions& options,
                      const FittedObject& object);

}  // namespace soslam

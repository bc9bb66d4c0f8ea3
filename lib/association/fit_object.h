// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "association/options.h"
#include "association/up_estimate.h"
#include "geometry/landmark.h"
#include "initialisation/semantic_table.h"
#include "model/estimates.h"
#include "model/sequence.h"

namespace soslam {

struct FittedObject {
  Landmark landmark_in_world;
  Covariance9 covariance;  // over the parameters of kLandmarkDof
};

// The landmark of an object from its detections (indices into Sequence::detections, at least one;
// all on one plane), of which max_views are used, and its covariance: the inverse of the
// information in boxes and prior, with views from one side counted as one. None when the boxes do
// not determine a body in front of the cameras.
//
// In a sequence without planes `up` (of the segment) stands for them: the body is upright at any
// height, its size and so its distance are first known from the prior's height_m, which is then
// needed. That up may be wrong, and what of the landmark has adapted to it, is in the covariance.
std::optional<FittedObject> FitObject(const Sequence& sequence, const std::vector<int>& detections,
                                      const ShapePrior& prior, const AssociateOptions& options,
                                      const std::optional<UpEstimate>& up = std::nullopt);

}  // namespace soslam

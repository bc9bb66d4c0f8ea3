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

// Fits an object's landmark to its detections (indices in Sequence::detections, at least one, all
// on one plane), of which at most max_views are used. The covariance is the inverse of the
// information of boxes and prior; views from one side count as one. None when the boxes do not
// determine a landmark in front of the cameras.
//
// In a sequence without planes, `up` (of the segment) replaces them: the object is upright at a
// free height, and its prior's height_m, which is then required, fixes the scale and thus the
// distance. The covariance includes the uncertainty of `up`, with the landmark adapting to it.
std::optional<FittedObject> FitObject(const Sequence& sequence, const std::vector<int>& detections,
                                      const ShapePrior& prior, const AssociateOptions& options,
                                      const std::optional<UpEstimate>& up = std::nullopt);

}  // namespace soslam

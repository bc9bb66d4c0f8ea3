// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "association/options.h"
#include "geometry/landmark.h"
#include "initialisation/semantic_table.h"
#include "model/sequence.h"

namespace soslam {

// Covariance of an UprightVector.
using UprightCovariance = Eigen::Matrix<double, 6, 6>;

struct FittedObject {
  Landmark landmark_in_world;
  UprightCovariance covariance;
};

// The landmark of an object from its detections (indices into Sequence::detections, at least one;
// all on one plane), of which max_views are used, and its covariance: the inverse of the
// information in boxes and prior, with views from one side counted as one. None when the boxes do
// not determine a body in front of the cameras.
std::optional<FittedObject> FitObject(const Sequence& sequence, const std::vector<int>& detections,
                                      const ShapePrior& prior, const AssociateOptions& options);

// The support plane that comes with a detection, in the world.
const Plane& PlaneOfDetection(const Sequence& sequence, const Detection& detection);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "soslam/association/options.h"
#include "soslam/model/semantic_table.h"
#include "soslam/model/sequence.h"
#include "soslam/planes/planes_estimate.h"
#include "soslam/planes/up_prior.h"

namespace soslam {

// Up direction of a world without support planes, from the way the cameras are held, or as the
// sequence's ground has it.
struct UpEstimate {
  Eigen::Vector3d up_in_world;
  // Covariance (rad^2, world axes) of the rotation vector from the estimated to the true up; zero
  // about up itself.
  Eigen::Matrix3d covariance;
  CameraOrientation orientation = CameraOrientation::kLevel;  // most probable one
  std::vector<TriedOrientation> orientations = {};            // one per tried direction of up
  // Variance of up over the alternatives (rad^2); 0 where the choice is clear.
  double orientation_tilt_variance = 0.0;
};

// `other_variance`: of up over alternatives (rad^2), which is added.
UpEstimate MakeUpEstimate(const UpPrior& prior, double other_variance = 0.0);

// Shape prior of a label's objects; it always has a height, also where the table has none.
ShapePrior PriorOfLabel(const SemanticTable& table, const std::string& label,
                        const AssociateOptions& options);

// Up direction per segment, as each segment has a world of its own: that of the sequence's ground
// or, where there is none, from the way the cameras are held, which follows from the cost of
// fitting upright bodies of the label's shape to single boxes.
std::map<int, UpEstimate> UpOfSegments(const Sequence& sequence, const SemanticTable& table,
                                       const AssociateOptions& options);

}  // namespace soslam

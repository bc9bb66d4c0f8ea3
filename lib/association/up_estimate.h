// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "association/options.h"
#include "initialisation/semantic_table.h"
#include "model/sequence.h"
#include "planes/planes_estimate.h"

namespace soslam {

// Where up is in a world without support planes, as cameras are held.
struct UpEstimate {
  Eigen::Vector3d up_in_world;
  // Of the rotation vector that turns it to where it really is (rad^2, world axes); zero about
  // itself.
  Eigen::Matrix3d covariance;
  CameraHolding holding = CameraHolding::kLevel;  // the most probable way to hold cameras
  std::vector<TriedHolding> holdings = {};        // one for each direction of up that was tried
  double holding_tilt_variance = 0.0;             // rad^2, by the others; 0 where one is clear
};

// Of a label's objects, with a height also where the table has none.
ShapePrior PriorOfLabel(const SemanticTable& table, const std::string& label,
                        const AssociateOptions& options);

// By segment, each with a world of its own. How the cameras are held, single boxes say: what it
// costs to take each for that of an upright body of its label.
std::map<int, UpEstimate> UpOfSegments(const Sequence& sequence, const SemanticTable& table,
                                       const AssociateOptions& options);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "soslam/planes/standing_body.h"

namespace soslam {

// Evidence after marginalising a height offset of the body from the plane with this standard
// deviation (m).
PlaneEvidence WithHeightNoise(const PlaneEvidence& evidence, double height_sigma);

// Assignment of objects to parallel planes ("levels").
struct PlaneHeights {
  Eigen::Vector2d tilt = Eigen::Vector2d::Zero();  // as in PlaneMotion
  std::vector<double> heights;  // heights of the planes along the tilted normal (m), ascending
  std::vector<int> level_of;    // index in `heights`, for each object
  double cost = 0.0;
};

// Finds the assignment to levels of least cost. Each object gives evidence on the motion of its
// plane; all motions share their rotations and have their own translations, to first order from
// `heights` (m, along the normal), the height of each object's plane. The tilt is searched on a
// grid up to max_tilt (rad) in either direction; `prior` is a prior on the tilt (its translation is
// not used). Every level costs `new_level_cost`. At least one object; each one's information about
// its own height is positive.
PlaneHeights ClusterPlaneHeights(const std::vector<PlaneEvidence>& evidence,
                                 const std::vector<double>& heights, const PlaneEvidence& prior,
                                 double max_tilt, double new_level_cost);

}  // namespace soslam

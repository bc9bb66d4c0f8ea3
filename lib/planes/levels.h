// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "planes/standing_body.h"

namespace soslam {

// The evidence when the body may stand this much (m, standard deviation) above or below the plane.
PlaneEvidence Loosened(const PlaneEvidence& evidence, double height_sigma);

// Which objects stand on the same of several parallel planes.
struct Levels {
  Eigen::Vector2d tilt = Eigen::Vector2d::Zero();  // as in PlaneMotion
  std::vector<double> heights;                     // ascending, along the tilted normal (m)
  std::vector<int> level_of;                       // for each object
  double cost = 0.0;
};

// The levels of lowest cost for objects that each say something about the motion of the plane that
// they stand on: all motions share their turns and have rises of their own, to first order from
// `heights` (m, along the normal), the height of each object's plane. The tilt is searched up to
// max_tilt (rad) either way on a grid; `prior` is what else is known of it (its rise is not used).
// Every level costs `new_level_cost`. At least one object; each one's information about its own
// height is positive.
Levels FindLevels(const std::vector<PlaneEvidence>& evidence, const std::vector<double>& heights,
                  const PlaneEvidence& prior, double max_tilt, double new_level_cost);

}  // namespace soslam

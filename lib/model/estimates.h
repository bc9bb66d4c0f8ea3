// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "geometry/landmark.h"
#include "geometry/plane.h"
#include "geometry/rigid3.h"

namespace soslam {

// One landmark that explains an observation, with the cost at which it does (half the sum of
// squared weighted residuals, no unit).
struct Hypothesis {
  Landmark landmark_in_camera;
  double cost = 0.0;
};

// What one observation alone says about its object. `hypotheses` is sorted best first; the first
// one is the estimate. `failure` says why there is none (hypotheses empty), or why a later stage
// left the estimate as it was.
struct ObservationEstimate {
  int detection_index = 0;  // into Sequence::detections
  std::vector<Hypothesis> hypotheses;
  std::string failure;
};

// The failure of an object that is not known to stand still, which has no place in the map.
inline constexpr const char* kMovingObject = "moving";

using Covariance9 = Eigen::Matrix<double, 9, 9>;

// What all observations of an object together say about it. Covariance over (rotation vector in the
// world frame, rad; centre in the world frame, m; log half axes).
struct ObjectEstimate {
  int object_index = 0;  // into Sequence::objects
  int observations = 0;  // how many detections it comes from
  std::optional<Landmark> landmark_in_world;
  std::optional<Covariance9> covariance;
  std::string failure;           // why there is no landmark
  bool proper_ellipsoid = true;  // false: see LandmarkFromDualQuadric
};

// The landmarks that a stage found: per observation, per object, or both.
struct LandmarkEstimates {
  std::vector<ObservationEstimate> observations;
  std::vector<ObjectEstimate> objects;
};

// Texture and edges join in when the rest has settled: initial_cost is the first solve's of all
// frames, without them; final_cost is the last one's, with them; the iterations are those of all
// solves, but not of a start in parts. Converged: so did the last solve, and choosing texture and
// edges anew changed nothing more.
struct SolverSummary {
  double initial_cost = 0.0;
  double final_cost = 0.0;
  int iterations = 0;
  bool converged = false;
  std::vector<double> cost_per_iteration;
  std::map<std::string, int> residuals;  // by kind: boxes, pairs of pixels, or blocks
  std::map<std::string, int> gated;      // what was left out before the solve, by reason
  // How far outwards the left, top, right and bottom edges of all boxes have to move to fit; zero
  // where no bias is estimated.
  std::array<double, 4> detector_bias_px{};
};

// The result of the back end.
struct MapEstimate {
  std::vector<ObjectEstimate> objects;
  std::vector<Rigid3d> world_from_camera;  // one per Sequence::frames
  std::vector<Plane> planes_in_world;      // one per Sequence::planes; given ones as they were
  SolverSummary solver;
  // By index into Sequence::planes, of estimated ones: over (normal, offset).
  std::map<int, Eigen::Matrix4d> plane_covariances = {};
};

}  // namespace soslam

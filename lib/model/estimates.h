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

// One landmark that fits an observation, with its cost (half the sum of squared weighted residuals,
// no unit).
struct Hypothesis {
  Landmark landmark_in_camera;
  double cost = 0.0;
};

// Estimate of an object from one observation alone. `hypotheses` is sorted best first; the first
// one is the estimate. `failure` gives the reason when there is none (hypotheses empty), or when a
// later stage left the estimate unchanged.
struct ObservationEstimate {
  int detection_index = 0;  // index in Sequence::detections
  std::vector<Hypothesis> hypotheses;
  std::string failure;
};

// Failure of an object that is not known to be static and thus has no place in the map.
inline constexpr const char* kMovingObject = "moving";

using Covariance9 = Eigen::Matrix<double, 9, 9>;

// Sparse point that may be of an object, and what the object's landmark says of it.
struct PointPosterior {
  int index = 0;                // in the list of all points
  double distance = 0.0;        // from the surface, m, positive outside
  double responsibility = 0.0;  // posterior probability that it is of the object
};

// Estimate of an object from all its observations. Covariance over (rotation vector in the world
// frame, rad; centre in the world frame, m; log half axes).
struct ObjectEstimate {
  int object_index = 0;  // index in Sequence::objects
  int observations = 0;  // number of detections used
  std::optional<Landmark> landmark_in_world;
  std::optional<Covariance9> covariance;
  std::string failure;                      // reason when there is no landmark
  bool proper_ellipsoid = true;             // false: see LandmarkFromDualQuadric
  std::vector<PointPosterior> points = {};  // evidence for the landmark, beside the detections
};

// The landmarks that a stage found: per observation, per object, or both.
struct LandmarkEstimates {
  std::vector<ObservationEstimate> observations;
  std::vector<ObjectEstimate> objects;
};

// Summary of all solves. Texture and edges are added once boxes alone have converged: initial_cost
// is that of the first solve over all frames, without them; final_cost is that of the last solve,
// with them; iterations are the sum over all solves, except those of a start in parts. `converged`:
// the last solve converged, and a new selection of texture and edges changed nothing.
struct SolverSummary {
  double initial_cost = 0.0;
  double final_cost = 0.0;
  int iterations = 0;
  bool converged = false;
  std::vector<double> cost_per_iteration;
  std::map<std::string, int> residuals;  // count per kind: boxes, pixel pairs, or blocks
  std::map<std::string, int> gated;      // count per reason of what was left out before the solve
  // Outward offset (px) of the left, top, right and bottom edges that makes all boxes fit best;
  // zero where no bias is estimated.
  std::array<double, 4> detector_bias_px{};
};

// The result of the back end.
struct MapEstimate {
  std::vector<ObjectEstimate> objects;
  std::vector<Rigid3d> world_from_camera;  // one per Sequence::frames
  std::vector<Plane> planes_in_world;      // one per Sequence::planes; given ones are unchanged
  SolverSummary solver;
  // Covariances of estimated planes over (normal, offset), keyed by index in Sequence::planes.
  std::map<int, Eigen::Matrix4d> plane_covariances = {};
};

}  // namespace soslam

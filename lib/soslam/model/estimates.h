// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "soslam/geometry/angles.h"
#include "soslam/geometry/landmark.h"
#include "soslam/geometry/plane.h"
#include "soslam/geometry/rigid3.h"

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
inline constexpr const char* kFewerThanThreeMeasuredEdges = "fewer_than_three_measured_edges";

// Over the degrees of freedom of a landmark, in the order of kLandmarkDof: rotation, centre, log
// half axes.
using Covariance9 = Eigen::Matrix<double, 9, 9>;

// Sparse point that may be of an object, and what the object's landmark says of it.
struct PointPosterior {
  int point = 0;                // index in the list of all points
  double distance = 0.0;        // from the surface, m, positive outside
  double responsibility = 0.0;  // posterior probability that it is of the object
};

// Least probability of a front that counts as known.
inline constexpr double kKnownFrontProbability = 0.9;

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
  // Probability that its x axis, modulo half a turn, is rather a quarter turn on, if it was asked.
  std::optional<double> quarter_turn = {};
  // Probability that its front is the direction of its x axis. None where nothing tells the front,
  // where its label has none (ShapePrior::has_front), and where it does not rest on its bottom.
  std::optional<double> front_probability = {};

  bool FrontIsKnown() const { return front_probability >= kKnownFrontProbability; }
};

// The landmarks that a stage found: per observation, per object, or both.
struct LandmarkEstimates {
  std::vector<ObservationEstimate> observations;
  std::vector<ObjectEstimate> objects;
};

// Summary of all solves. Texture and edges are added once boxes alone have converged: initial_cost
// is that of the first solve over all frames, without them; final_cost is that of the last solve,
// with them; iterations are the sum over all solves. `converged`: the last solve converged, and a
// new selection of texture and edges changed nothing.
struct SolverSummary {
  double initial_cost = 0.0;
  double final_cost = 0.0;
  double constant_cost = 0.0;      // of texture and edges that no landmark nearby shows
  double box_cost = 0.0;           // part of the boxes in final_cost
  double expected_box_cost = 0.0;  // of boxes that contain only their noise: 1/2 for each edge,
                                   // times the weight of its view
  int iterations = 0;
  bool converged = false;
  std::vector<double> cost_per_iteration;
  std::map<std::string, int> residuals;  // count per kind: boxes, pixel pairs, or blocks
  std::map<std::string, int> gated;      // count per reason of what was left out before the solve
  // Outward offset (px) of the left, top, right and bottom edges that makes all boxes fit best;
  // zero where no bias is estimated.
  std::array<double, 4> detector_bias_px{};

  // The variance factor of the boxes a posteriori, where they cost more than their noise gives by
  // chance; else 1.
  double Dispersion() const { return std::max(1.0, box_cost / expected_box_cost); }
};

// A support plane that is free, and how it differs from the given one where objects stand on it.
struct PlaneAlternative {
  Plane plane_in_world;
  double height_change_m = 0.0;  // along the given normal
  double tilt_rad = 0.0;
};

// How well the back end explains the boxes, without images and points, if some of what is given to
// it is free.
struct InputAlternative {
  int degrees = 0;                              // degrees of freedom of what is free
  double cost = 0.0;                            // the whole cost at its minimum
  double box_cost = 0.0;                        // part of the boxes in it
  double focal_factor = 1.0;                    // of fx and fy of all cameras
  std::map<int, PlaneAlternative> planes = {};  // those that are free, by index in Sequence::planes
};

// The result of the back end.
struct MapEstimate {
  std::vector<ObjectEstimate> objects;
  std::vector<Rigid3d> world_from_camera;  // one per Sequence::frames
  std::vector<Plane> planes_in_world;      // one per Sequence::planes; given ones are unchanged
  SolverSummary solver;
  // Covariances of estimated planes over (normal, offset), keyed by index in Sequence::planes.
  std::map<int, Eigen::Matrix4d> plane_covariances = {};
  // With bodies of any shape. First that with all that is given, then those that may be better.
  std::vector<InputAlternative> input_alternatives = {};
};

// Result of the symmetry search on one observation's texture for the yaw of its object (figures 7
// and 8). Yaws are angles of the object's x axis about the support normal, in the camera frame, rad
// (see Yaw()).
struct SymmetryRecord {
  int frame_id = 0;
  int object_id = 0;
  std::vector<double> yaw;  // yaws of the grid
  // Name of the descriptor, or of the part of an orientation profile -> cost at each yaw of the
  // grid; NaN where too few pairs count.
  std::map<std::string, std::vector<double>> cost;
  // Used pixels and their mirror pixels at the refined yaw.
  std::vector<Eigen::Vector2f> samples;
  std::vector<Eigen::Vector2f> mirrored;
  // NaN when the observation has no landmark.
  double initial_yaw = std::numeric_limits<double>::quiet_NaN();
  double refined_yaw = std::numeric_limits<double>::quiet_NaN();
  std::optional<double> yaw_sigma;  // standard deviation of the refined yaw, if known
  // Number of vertical planes in which the visible texture is symmetric: 2 for xz and yz, 1 for xz
  // alone, 0 for none. Only for an orientation profile with texture.
  std::optional<int> mirror_planes;
  std::optional<double> true_yaw;  // where there is ground truth
};

}  // namespace soslam

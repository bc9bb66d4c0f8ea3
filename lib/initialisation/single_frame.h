// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/problem.h>

#include <Eigen/Core>
#include <string>
#include <vector>

#include "constraints/parameters.h"
#include "geometry/box.h"
#include "geometry/camera.h"
#include "geometry/plane.h"
#include "initialisation/options.h"
#include "model/estimates.h"

namespace soslam {

// What one frame knows of an object: nine equations for nine unknowns.
struct SingleFrameObservation {
  Camera camera;
  Box box;
  Plane plane_in_camera;  // the support plane
  Eigen::Vector2d ratio;  // (a / c, b / c)
  // A horizontal axis of the world, for TieBreak::kWorldAxes.
  Eigen::Vector3d world_axis_in_camera = Eigen::Vector3d::UnitX();
};

struct SingleFrameSolution {
  std::vector<Hypothesis> hypotheses;  // best first
  std::string failure;                 // why there is none
};

// Single-frame initialisation, eq. (12): Levenberg-Marquardt over detection, support and ratio
// constraints from starting yaws all around. One box can be explained exactly by several yaws,
// typically two, mirrored in the line of sight: all distinct solutions are returned. Those that fit
// the box to options.tie_edge_px come first, in the order of options.tie_break; the rest follow by
// cost.
// Solutions that are not upright above the plane and in front of the camera are dropped. Failures:
// support_plane_not_in_view, no_solution.
SingleFrameSolution InitialiseFromSingleFrame(const SingleFrameObservation& observation,
                                              const InitialiseOptions& options);

// The constraints of eq. (12) on a landmark in the camera frame. The blocks stay the caller's; the
// camera block is the identity and held constant.
void AddSingleFrameConstraints(const SingleFrameObservation& observation,
                               const ConstraintVariances& variances, PoseBlock* camera,
                               LandmarkBlock* landmark, ceres::Problem* problem);

// The cost of eq. (12): half the sum of squared weighted residuals.
double SingleFrameCost(const SingleFrameObservation& observation,
                       const ConstraintVariances& variances, const Landmark& landmark_in_camera);

}  // namespace soslam

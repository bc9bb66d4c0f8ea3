// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

#include "geometry/box.h"
#include "geometry/camera.h"
#include "geometry/plane.h"
#include "initialisation/options.h"
#include "model/estimates.h"

namespace soslam {

// Measurements of an object in one frame: nine equations for nine unknowns.
struct SingleFrameObservation {
  Camera camera;
  Box box;
  Plane plane_in_camera;  // the support plane
  Eigen::Vector2d ratio;  // (a / c, b / c)
  // For TieBreak::kSceneAxes, see SupportPlane. Where there is none, the line of sight decides.
  std::optional<Eigen::Vector3d> scene_axis_in_camera = std::nullopt;
};

// Single-frame initialisation, eq. (12): Levenberg-Marquardt over detection, support and ratio
// constraints from starting yaws over half a turn. Several yaws can fit one box exactly, typically
// two, mirrored in the line of sight: all distinct solutions are returned. Solutions that fit the
// box as well as the best one, to options.tie_edge_px, come first, in the order of
// options.tie_break; the others follow by cost.
// Solutions that are not upright above the plane and in front of the camera are dropped. Failures:
// support_plane_not_in_view, no_solution. The caller sets the index of the detection.
ObservationEstimate InitialiseFromSingleFrame(const SingleFrameObservation& observation,
                                              const InitialiseOptions& options);

// The cost of eq. (12): half the sum of squared weighted residuals.
double SingleFrameCost(const SingleFrameObservation& observation,
                       const ConstraintVariances& variances, const Landmark& landmark_in_camera);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "soslam/base/options.h"
#include "soslam/constraints/variances.h"
#include "soslam/geometry/box.h"
#include "soslam/geometry/camera.h"
#include "soslam/geometry/plane.h"
#include "soslam/model/estimates.h"
#include "soslam/model/sequence.h"

namespace soslam {

// Choice among several yaws that fit a box equally well. The box does not determine it; the choices
// are assumptions about how objects stand.
enum class TieBreak {
  kSceneAxes,     // along the scene's straight edges: furniture stands along walls
  kFacingCamera,  // front (or back) towards the camera: what is looked at is mostly seen from the
                  // front
};
inline constexpr std::array kTieBreakNames = {"scene_axes", "facing_camera"};

// Ellipsoids of single frames.
struct SingleFrameOptions {
  int yaw_starts = 12;
  int max_iterations = 100;
  double tie_edge_px = 1.0;
  TieBreak tie_break = TieBreak::kSceneAxes;
  ConstraintVariances variances;

  void Describe(OptionVisitor& visit) {
    visit.Group("Ellipsoids of single frames");
    visit.Integer("yaw_starts", &yaw_starts, {1, 360},
                  "starting yaws over half a turn of the solve, eq. (12)");
    visit.Integer("max_iterations", &max_iterations, {1, 10000},
                  "Levenberg-Marquardt iterations per start");
    visit.Real("tie_edge_px", &tie_edge_px, {0.0, 1000.0},
               "solutions whose outline fits the box as well as that of the best one, to this rms "
               "edge distance, count as equal; tie_break chooses among them");
    visit.Choice("tie_break", &tie_break, kTieBreakNames,
                 "which yaw is chosen among equal solutions: nearest to the scene's axes (modulo "
                 "quarter turns), or with the front facing the camera most");
    variances.Describe(visit);
  }
};

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
                                              const SingleFrameOptions& options);

// The cost of eq. (12): half the sum of squared weighted residuals.
double SingleFrameCost(const SingleFrameObservation& observation,
                       const ConstraintVariances& variances, const Landmark& landmark_in_camera);

}  // namespace soslam

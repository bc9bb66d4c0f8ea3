// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "soslam/geometry/box.h"
#include "soslam/geometry/camera.h"
#include "soslam/geometry/landmark.h"
#include "soslam/geometry/plane.h"
#include "soslam/geometry/rigid3.h"
#include "soslam/image/edge_maps.h"

// The paper's method as it describes it, to compare times with: ellipsoids of nine parameters,
// residuals of its equations by their matrices, derivatives by central differences, dense
// Levenberg-Marquardt over everything. It shares no mathematics with lib/: what is made faster
// there does not make this faster. Weights are those of docs/paper.md.
namespace soslam::paper {

// One box of the object; with `edge_maps` its texture counts, too.
struct View {
  Rigid3d world_from_camera;
  Box box;
  const EdgeMaps* edge_maps = nullptr;
};

struct Observations {
  Camera camera;
  std::vector<View> views;
  Plane plane_in_world;
  Eigen::Vector2d ratio;  // (a / c, b / c)
};

// Where single-frame optimisation begins: on the plane at the box's lower edge, as large as the box
// is wide there, at a given yaw. None when the plane is not in view there.
std::optional<Landmark> Start(const Observations& observations, double yaw);

struct Solution {
  Landmark landmark_in_world;
  double cost;
  int iterations;
};

// Eq. (12), over the landmark alone: of one view, whose texture counts by eq. (24) if it has edge
// maps.
Solution SolveSingleFrame(const Observations& observations, const Landmark& start_in_world);

// Eq. (1), over the landmark and all poses but the first, with odometry between consecutive views.
Solution SolveAllFrames(const Observations& observations, const Landmark& start_in_world);

}  // namespace soslam::paper

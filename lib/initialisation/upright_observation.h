// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "base/options.h"
#include "constraints/landmark_terms.h"
#include "constraints/point_cost.h"
#include "constraints/tangency.h"
#include "geometry/camera.h"
#include "geometry/plane.h"
#include "model/sequence.h"
#include "model/shape_prior.h"

namespace soslam {

// Options of the fit of an upright landmark to the box of one detection.
struct UprightOptions {
  double detection_sigma_fraction = 0.02;
  double axes_weight = 1.0;
  double yaw_grid_deg = 3.0;

  void Describe(OptionVisitor& visit) {
    visit.Group("Upright bodies (any shape, on a grid of yaws)");
    visit.Real("detection_sigma_fraction", &detection_sigma_fraction, {1e-4, 1.0},
               "standard deviation of a detector's box edge, as a fraction of the box's width or "
               "height; at least 1 px");
    visit.Real(
        "axes_weight", &axes_weight, {0.0, 1e6},
        "cost (negative logarithm of a likelihood) of a yaw half-way between the axes of the "
        "scene, along which its straight edges lie; 0 if objects are not aligned with them");
    visit.Real("yaw_grid_deg", &yaw_grid_deg, {0.1, 45.0}, "grid of the sweep over half a turn");
  }
};

// One box of an object and its priors.
struct UprightObservation {
  Camera camera;
  std::array<BoxEdge, 4> edges;
  Plane plane_in_camera;
  ShapePrior prior;
  std::optional<Eigen::Vector3d> scene_axis_in_camera = std::nullopt;
  double axes_weight = 0.0;
  std::optional<YawPrior> yaw_prior = std::nullopt;
  std::optional<PointEvidence> points = std::nullopt;
};
UprightObservation MakeUprightObservation(const Sequence& sequence, const Detection& detection,
                                          const ShapePrior& prior, const UprightOptions& options);

// Costs of a landmark in the camera: box, with the tangent points at the depths that they have on
// `start`, ratio, scene axes, yaw prior and points, with the widths that they have on `start`.
LandmarkCosts ObservationTerms(const UprightObservation& observation,
                               const Landmark& start_in_camera);

// SupportPlane::scene_axis_in_world of a detection's plane.
std::optional<Eigen::Vector3d> SceneAxisInCamera(const Sequence& sequence,
                                                 const Detection& detection);

}  // namespace soslam

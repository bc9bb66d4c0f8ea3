// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "constraints/tangency.h"
#include "geometry/camera.h"
#include "geometry/plane.h"
#include "initialisation/semantic_table.h"
#include "initialisation/upright_options.h"
#include "model/sequence.h"

namespace soslam {

// Prior of an object's yaw (rad, see Yaw), modulo half a turn.
struct YawPrior {
  double yaw = 0.0;
  double sigma = 1.0;  // standard deviation, rad
};

// One box of an object and its priors.
struct UprightObservation {
  Camera camera;
  std::array<BoxEdge, 4> edges;
  Plane plane_in_camera;
  ShapePrior prior;
  Eigen::Vector3d world_axis_in_camera = Eigen::Vector3d::UnitX();  // horizontal axis of the world
  double axes_weight = 0.0;
  std::optional<YawPrior> yaw_prior = std::nullopt;
};
UprightObservation MakeUprightObservation(const Sequence& sequence, const Detection& detection,
                                          const ShapePrior& prior, const UprightOptions& options);

// A horizontal axis of the world at a detection's support plane: x, or y where x is vertical.
Eigen::Vector3d WorldAxisInCamera(const Sequence& sequence, const Detection& detection);

}  // namespace soslam

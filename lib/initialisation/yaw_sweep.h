// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "constraints/tangency.h"
#include "geometry/camera.h"
#include "geometry/plane.h"
#include "initialisation/upright.h"
#include "initialisation/upright_options.h"
#include "initialisation/yaw_term.h"
#include "model/sequence.h"

namespace soslam {

// One box of an object, and what is known beforehand.
struct UprightObservation {
  Camera camera;
  std::array<BoxEdge, 4> edges;
  Plane plane_in_camera;
  ShapePrior prior;
  Eigen::Vector3d world_axis_in_camera = Eigen::Vector3d::UnitX();  // horizontal
  double axes_weight = 0.0;
  std::optional<YawPrior> yaw_prior = std::nullopt;
};
UprightObservation MakeUprightObservation(const Sequence& sequence, const Detection& detection,
                                          const ShapePrior& prior, const UprightOptions& options);

// A horizontal axis of the world at a detection's support plane: x, or y where x is vertical.
Eigen::Vector3d WorldAxisInCamera(const Sequence& sequence, const Detection& detection);

// At a given yaw and with the prior's ratio, the tangencies are linear in the foot and the size:
// the least squares solution over the measured edges, and over those bounds that it would not
// reach. Tangent points are at their depths on the solution itself, found by repetition. None when
// fewer than three edges are measured, which leaves the size open, or when the body would not be in
// front of the camera.
std::optional<Landmark> SolveAtYaw(const UprightObservation& observation, double yaw);

// The failure of an observation for which SolveAtYaw finds nothing at any yaw.
std::string WhyNoSolution(const UprightObservation& observation);

// What makes one yaw better than another.
struct YawObjective {
  // What the landmark at each yaw is fitted to, starting from the given one. Called again with the
  // result, `rounds` times in all, where terms depend on their start.
  std::function<LandmarkTerms(const Landmark& start_in_camera)> terms;
  int rounds = 1;
  // What counts on top for the yaw, but not for the fit; may be empty.
  std::function<double(const Landmark& landmark_in_camera)> extra_cost;
};

// Box, ratio prior, world axes and yaw prior.
YawObjective BoxObjective(const UprightObservation& observation);

// The landmark that is best at each yaw of a grid over half a turn, and its cost. Entries without a
// landmark are empty.
struct YawSweep {
  std::vector<double> yaw;  // rad, see Yaw
  std::vector<std::optional<UprightSolution>> solutions;

  std::vector<double> Costs() const;  // NaN where there is no landmark
  // The spread of the yaw (rad) about the first of its optima (yaw and cost; between those of the
  // grid), when exp(-cost) is its likelihood.
  struct Optimum {
    double yaw;
    double cost;
  };
  double StandardDeviation(const std::vector<Optimum>& optima) const;
};
YawSweep SweepYaw(const UprightObservation& observation, const YawObjective& objective,
                  double step);

// The indices of a circular curve's local minima, lowest first, of flat ones their first; NaN
// counts as high.
std::vector<size_t> CircularMinima(const std::vector<double>& values);

// The best `max_count` local optima of the sweep, yaw refined, lowest cost first.
std::vector<UprightSolution> LocalOptima(const UprightObservation& observation,
                                         const YawObjective& objective, const YawSweep& sweep,
                                         size_t max_count);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "soslam/model/world.h"

namespace soslam {

// Two axes in the camera's frame: `level` is horizontal up to the roll's deviation; `up` is
// vertical when the third axis is horizontal too, up to the pitch's deviation.
struct OrientationAxes {
  Eigen::Vector3d level;
  Eigen::Vector3d up;
};
OrientationAxes AxesOf(CameraOrientation orientation);

// Costs of one hypothesis on how the cameras are held (negative log likelihoods).
struct OrientationEvidence {
  CameraOrientation orientation = CameraOrientation::kLevel;
  bool ignores_verticals = false;  // vertical edges are ignored as wrongly classified
  Eigen::Vector3d up_in_world = Eigen::Vector3d::UnitZ();
  // Per object, the cost of its boxes given the best upright body; none where there is no such
  // body.
  std::vector<std::optional<double>> object_costs;
  double other_cost = 0.0;  // further costs, such as that of the number of planes
  // Share of the boxes whose camera is below the plane that the object stands on.
  double share_from_below = 0.0;
  bool can_be_chosen = true;  // otherwise it only makes the choice less certain
};

struct OrientationChoice {
  size_t best = 0;  // index in the evidence
  // Per hypothesis: total cost relative to the best one, and probability.
  std::vector<double> costs;
  std::vector<double> probabilities;
  // Variance of the chosen up direction (rad^2) over the alternatives; zero where the choice is
  // clear.
  double tilt_variance = 0.0;
};

// Negative log prior probability of each orientation other than level.
inline const double kNotLevelCost = std::log(100.0);

// True if two up directions differ by at most a few degrees, which boxes cannot distinguish.
// Orientations with the same up are the same hypothesis.
bool IsSameUp(const Eigen::Vector3d& one, const Eigen::Vector3d& other);

// A choice is clear when all hypotheses with another up direction have less probability than this
// in total.
inline constexpr double kClearOrientation = 0.01;

// Chooses the most probable hypothesis; at least one can be chosen, and all have the same objects.
// Prior probabilities: 1/100 for each orientation other than level and for wrongly classified
// vertical edges, 1/1000 for all objects seen from below their planes. If the objects cost more
// than `expected_cost` even in the best case, the boxes are less informative than their noise
// model: their costs are scaled down accordingly. The cost of a single object is bounded, as its
// boxes may belong to several objects.
OrientationChoice ChooseOrientation(const std::vector<OrientationEvidence>& evidence,
                                    double expected_cost, double clear = kClearOrientation);

}  // namespace soslam

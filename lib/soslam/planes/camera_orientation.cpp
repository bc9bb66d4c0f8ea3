// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/planes/camera_orientation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "soslam/geometry/angles.h"

namespace soslam {

OrientationAxes AxesOf(CameraOrientation orientation) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  const std::array<OrientationAxes, 6> axes = {
      {{x, -y}, {y, -x}, {x, y}, {y, x}, {x, -z}, {y, -z}}};  // in the order of CameraOrientation
  return axes.at(static_cast<size_t>(orientation));
}

namespace {

// Negative log prior probabilities: wrongly classified vertical edges, all objects seen from below,
// an object with wrong boxes.
const double kWrongVerticals = std::log(100.0);
const double kFromBelow = std::log(1000.0);
const double kWrongObject = std::log(1e4);

constexpr double kSameUp = 5.0 * kRadPerDeg;

}  // namespace

bool IsSameUp(const Eigen::Vector3d& one, const Eigen::Vector3d& other) {
  return AngleBetween(one, other) < kSameUp;
}

OrientationChoice ChooseOrientation(const std::vector<OrientationEvidence>& evidence,
                                    double expected_cost, double clear) {
  // Per object, the lowest cost over all evidence; infinite for one that has no body in any.
  std::vector<double> lowest(evidence.front().object_costs.size(),
                             std::numeric_limits<double>::infinity());
  for (const OrientationEvidence& one : evidence) {
    for (size_t i = 0; i < lowest.size(); ++i) {
      if (one.object_costs[i]) lowest[i] = std::min(lowest[i], *one.object_costs[i]);
    }
  }
  // Factor, at least 1, by which the boxes cost more than expected from their noise.
  double sum_of_lowest = 0.0;
  for (const double cost : lowest) sum_of_lowest += std::isfinite(cost) ? cost : 0.0;
  const double misfit = expected_cost > 0.0 ? std::max(1.0, sum_of_lowest / expected_cost) : 1.0;
  OrientationChoice choice;
  for (const OrientationEvidence& one : evidence) {
    double cost = one.other_cost / misfit + kFromBelow * one.share_from_below;
    if (one.orientation != CameraOrientation::kLevel) cost += kNotLevelCost;
    if (one.ignores_verticals) cost += kWrongVerticals;
    for (size_t i = 0; i < lowest.size(); ++i) {
      if (!std::isfinite(lowest[i])) continue;
      const auto& own = one.object_costs[i];
      cost += own ? std::min(kWrongObject, (*own - lowest[i]) / misfit) : kWrongObject;
    }
    choice.costs.push_back(cost);
  }
  for (size_t i = 1; i < evidence.size(); ++i) {
    if (!evidence[i].can_be_chosen) continue;
    const bool is_lower = choice.costs[i] < choice.costs[choice.best];
    if (!evidence[choice.best].can_be_chosen || is_lower) choice.best = i;
  }
  const double best_cost = choice.costs[choice.best];
  // It may be that of an orientation that cannot be chosen.
  const double lowest_cost = std::ranges::min(choice.costs);
  double sum = 0.0;
  std::vector<double> weights;
  for (double& cost : choice.costs) {
    weights.push_back(std::exp(lowest_cost - cost));
    sum += weights.back();
    cost -= best_cost;
  }
  double variance = 0.0;
  double others = 0.0;
  for (size_t i = 0; i < evidence.size(); ++i) {
    choice.probabilities.push_back(weights[i] / sum);
    const double angle = AngleBetween(evidence[i].up_in_world, evidence[choice.best].up_in_world);
    variance += choice.probabilities[i] * angle * angle;
    if (!IsSameUp(evidence[i].up_in_world, evidence[choice.best].up_in_world))
      others += choice.probabilities[i];
  }
  if (others >= clear) choice.tilt_variance = variance;
  return choice;
}

}  // namespace soslam

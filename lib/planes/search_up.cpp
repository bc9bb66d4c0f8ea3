// SPDX-License-Identifier: BSD-3-Clause
#include "planes/search_up.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "geometry/angles.h"
#include "geometry/landmark.h"

namespace soslam {
namespace {

// Search range of up before boxes are used: this many standard deviations from the cameras' up.
constexpr double kMaxSigmas = 2.5;
constexpr double kMaxTiltOfCameras = 45.0 * kRadPerDeg;
constexpr double kTiltStep = 7.5 * kRadPerDeg;
// Initial guesses of up, farther apart than neighbours of the grid.
constexpr size_t kStarts = 4;
constexpr double kBetweenStarts = 1.6 * kTiltStep;
constexpr double kYawStepOfSearch = 6.0 * kRadPerDeg;

// Directions around the cameras' up, which comes first.
std::vector<Eigen::Vector3d> UpCandidates(const UpPrior& attitude) {
  const Eigen::Quaterniond level = UprightRotation(attitude.up_in_world, 0.0);
  const double lowest = attitude.up_in_world.dot(attitude.information * attitude.up_in_world);
  const int steps = static_cast<int>(kMaxTiltOfCameras / kTiltStep);
  std::vector<Eigen::Vector3d> candidates = {attitude.up_in_world};
  for (int i = -steps; i <= steps; ++i) {
    for (int k = -steps; k <= steps; ++k) {
      const Eigen::Vector3d turn(i * kTiltStep, k * kTiltStep, 0.0);
      if ((i == 0 && k == 0) || turn.norm() > kMaxTiltOfCameras) continue;
      const Eigen::Vector3d up = ExpRotation(level * turn) * attitude.up_in_world;
      if (up.dot(attitude.information * up) - lowest > kMaxSigmas * kMaxSigmas) continue;
      candidates.push_back(up);
    }
  }
  return candidates;
}

double CostOf(const Eigen::Vector3d& up, const UpPrior& attitude,
              const std::vector<std::optional<MultiViewObservation>>& observations) {
  double cost = 0.5 * up.dot(attitude.information * up);
  for (const auto& observation : observations) {
    if (observation) cost += CostOfUprightBody(up, *observation).value_or(kCostWithoutBody);
  }
  return cost;
}

}  // namespace

std::optional<double> CostOfUprightBody(const Eigen::Vector3d& up_in_world,
                                        MultiViewObservation observation) {
  observation.plane_in_world = {up_in_world, 0.0};
  const auto optima = SweepViews(observation, kYawStepOfSearch);
  return optima.empty() ? std::nullopt : std::optional(optima.front().cost);
}

std::vector<Eigen::Vector3d> SearchUp(
    const UpPrior& attitude, const std::vector<std::optional<MultiViewObservation>>& observations,
    int threads) {
  const std::vector<Eigen::Vector3d> candidates = UpCandidates(attitude);
  std::vector<double> costs(candidates.size());
  ParallelFor("directions of up", static_cast<int>(candidates.size()), threads, [&](int i) {
    const auto index = static_cast<size_t>(i);
    costs[index] = CostOf(candidates[index], attitude, observations);
  });
  std::vector<size_t> order(candidates.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t one, size_t other) { return costs[one] < costs[other]; });
  std::vector<Eigen::Vector3d> starts;
  for (const size_t i : order) {
    const bool is_apart = std::all_of(starts.begin(), starts.end(), [&](const auto& start) {
      return start.dot(candidates[i]) < std::cos(kBetweenStarts);
    });
    if (is_apart) starts.push_back(candidates[i]);
    if (starts.size() == kStarts) break;
  }
  return starts;
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "symmetry/yaw_profile.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace soslam {

std::optional<double> SymmetryCost(const SymmetryImage& image, const Camera& camera,
                                   const Landmark& landmark_in_camera,
                                   const std::vector<Eigen::Vector2d>& samples,
                                   Descriptor descriptor, const SymmetryOptions& options) {
  const SymmetryDescriptor evaluate(descriptor, image, camera, landmark_in_camera);
  double sum = 0.0;
  int pairs = 0;
  for (const Eigen::Vector2d& pixel : samples) {
    if (const auto pair = evaluate.Evaluate(pixel, options.min_viewing_cosine, false)) {
      sum += pair->residual * pair->residual;
      ++pairs;
    }
  }
  const double required = std::max(static_cast<double>(options.min_pairs),
                                   options.min_pair_fraction * static_cast<double>(samples.size()));
  if (pairs < required) return std::nullopt;
  return sum / pairs;
}

YawProfile ComputeYawProfile(const SymmetryImage& image, const Camera& camera,
                             const Landmark& landmark_in_camera,
                             const std::vector<Eigen::Vector2d>& samples, Descriptor descriptor,
                             const SymmetryOptions& options, double step) {
  YawProfile profile;
  const int count = std::max(1, static_cast<int>(std::round(std::numbers::pi / step)));
  for (int i = 0; i < count; ++i) {
    const double turn = std::numbers::pi * (static_cast<double>(i) / count - 0.5);
    const auto cost =
        SymmetryCost(image, camera, Turned(landmark_in_camera, turn), samples, descriptor, options);
    profile.turns.push_back(turn);
    profile.costs.push_back(cost.value_or(std::numeric_limits<double>::quiet_NaN()));
  }
  return profile;
}

std::optional<double> BestTurn(const YawProfile& profile, const SymmetryImage& image,
                               const Camera& camera, const Landmark& landmark_in_camera,
                               const std::vector<Eigen::Vector2d>& samples,
                               const SymmetryOptions& options, double resolution) {
  std::optional<double> best;
  double lowest = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < profile.turns.size(); ++i) {
    if (profile.costs[i] < lowest) {
      lowest = profile.costs[i];
      best = profile.turns[i];
    }
  }
  if (!best) return std::nullopt;

  const double coarse = *best;
  const double step = std::numbers::pi / static_cast<double>(profile.turns.size());
  for (double offset = -step; offset <= step; offset += resolution) {
    const auto cost = SymmetryCost(image, camera, Turned(landmark_in_camera, coarse + offset),
                                   samples, options.descriptor, options);
    if (cost && *cost < lowest) {
      lowest = *cost;
      best = coarse + offset;
    }
  }
  return best;
}

}  // namespace soslam

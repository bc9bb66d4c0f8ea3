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
      sum += std::abs(pair->residual);
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

std::optional<BestTurn> FindBestTurn(const SymmetryImage& image, const Camera& camera,
                                     const Landmark& landmark_in_camera,
                                     const std::vector<Eigen::Vector2d>& samples,
                                     const SymmetryOptions& options, double range, double step,
                                     double resolution) {
  std::optional<BestTurn> best;
  const auto search = [&](double centre, double half_width, double spacing) {
    const int count = static_cast<int>(std::ceil(half_width / spacing));
    for (int i = -count; i <= count; ++i) {
      const double turn = std::clamp(centre + half_width * i / std::max(1, count), -range, range);
      const auto cost = SymmetryCost(image, camera, Turned(landmark_in_camera, turn), samples,
                                     options.descriptor, options);
      if (cost && (!best || *cost < best->cost)) best = BestTurn{turn, *cost};
    }
  };
  search(0.0, range, step);
  if (best) search(best->turn, std::min(step, range), resolution);
  return best;
}

}  // namespace soslam

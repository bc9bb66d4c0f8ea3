// SPDX-License-Identifier: BSD-3-Clause
#include "orientation/yaw_profile.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace soslam {

std::vector<std::optional<double>> SymmetryCosts(const SymmetryImage& image, const Camera& camera,
                                                 const Landmark& landmark_in_camera,
                                                 const std::vector<Eigen::Vector2d>& samples,
                                                 const std::vector<Descriptor>& descriptors,
                                                 const SymmetryOptions& options) {
  struct Sum {
    SymmetryDescriptor descriptor;
    double residuals = 0.0;
    int pairs = 0;
  };
  std::vector<Sum> sums;
  for (const Descriptor descriptor : descriptors) {
    sums.push_back({{descriptor, image, camera, landmark_in_camera}});
  }
  for (const Eigen::Vector2d& pixel : samples) {
    const auto point = sums.front().descriptor.VisiblePoint(pixel, options.min_viewing_cosine);
    if (!point) continue;
    for (Sum& sum : sums) {
      const auto pair = sum.descriptor.EvaluateAt(pixel, *point, false);
      if (!pair) continue;
      sum.residuals += std::abs(pair->residual);
      ++sum.pairs;
    }
  }
  std::vector<std::optional<double>> costs;
  for (const Sum& sum : sums) {
    const bool is_known = sum.pairs >= options.MinPairs(samples.size());
    costs.push_back(is_known ? std::optional(sum.residuals / sum.pairs) : std::nullopt);
  }
  return costs;
}

YawProfile ComputeYawProfile(const SymmetryImage& image, const Camera& camera,
                             const Landmark& landmark_in_camera,
                             const std::vector<Eigen::Vector2d>& samples,
                             const std::vector<Descriptor>& descriptors,
                             const SymmetryOptions& options, double step) {
  YawProfile profile;
  profile.costs.resize(descriptors.size());
  const int count = std::max(1, static_cast<int>(std::round(std::numbers::pi / step)));
  for (int i = 0; i < count; ++i) {
    const double turn = std::numbers::pi * (static_cast<double>(i) / count - 0.5);
    const auto costs = SymmetryCosts(image, camera, RotatedAboutZ(landmark_in_camera, turn),
                                     samples, descriptors, options);
    profile.turns.push_back(turn);
    for (size_t k = 0; k < costs.size(); ++k) {
      profile.costs[k].push_back(costs[k].value_or(std::numeric_limits<double>::quiet_NaN()));
    }
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
      const auto cost = SymmetryCosts(image, camera, RotatedAboutZ(landmark_in_camera, turn),
                                      samples, {options.descriptor}, options)
                            .front();
      if (cost && (!best || *cost < best->cost)) best = BestTurn{turn, *cost};
    }
  };
  search(0.0, range, step);
  if (best) search(best->turn, std::min(step, range), resolution);
  return best;
}

}  // namespace soslam

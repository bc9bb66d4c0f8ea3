// SPDX-License-Identifier: BSD-3-Clause
#include "orientation/mirror_planes.h"

#include <cmath>
#include <numbers>

#include "geometry/landmark.h"

namespace soslam {
namespace {

// A texture counts as symmetric when its cost is below this fraction of the largest possible cost,
// that is when most of its pairs are symmetric.
constexpr double kSymmetricShare = 0.5;

}  // namespace

std::optional<int> MirrorPlanes(const std::vector<double>& grid,
                                const std::vector<double>& texture_cost, double yaw,
                                const TextureOptions& options) {
  const auto is_symmetric = [&](double at) -> std::optional<bool> {
    size_t nearest = 0;
    for (size_t i = 1; i < grid.size(); ++i) {
      if (std::abs(YawDifferenceModuloPi(grid[i], at)) <
          std::abs(YawDifferenceModuloPi(grid[nearest], at))) {
        nearest = i;
      }
    }
    // The grid may be coarser than the minimum is wide, so its neighbours are included.
    const size_t n = grid.size();
    double lowest = options.asymmetry_cost;
    for (const size_t i : {nearest + n - 1, nearest, nearest + 1}) {
      lowest = std::fmin(lowest, texture_cost[i % n]);
    }
    if (lowest == options.asymmetry_cost) return std::nullopt;
    return lowest < kSymmetricShare * options.asymmetry_cost;
  };
  const auto at_yaw = is_symmetric(yaw);
  if (!at_yaw) return std::nullopt;
  if (!*at_yaw) return 0;
  const auto across = is_symmetric(yaw + 0.5 * std::numbers::pi);
  if (!across) return std::nullopt;
  return *across ? 2 : 1;
}

}  // namespace soslam

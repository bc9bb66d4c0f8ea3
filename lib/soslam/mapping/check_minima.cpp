// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/mapping/check_minima.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "soslam/base/parallel.h"

namespace soslam {
namespace {

constexpr int kYaws = 8;
constexpr double kScales[] = {0.8, 1.25};

// Whether two bodies are the same but for the errors of convergence: their Hausdorff distance, the
// largest difference of their extents in any direction, is small beside their size. Half a turn, or
// any turn of a round body, changes no body.
bool AreSame(const Landmark& body, const Landmark& other) {
  constexpr double kTolerance = 0.02;
  for (int i = 0; i < 27; ++i) {
    const Eigen::Vector3d direction =
        Eigen::Vector3d(i % 3, i / 3 % 3, i / 9) - Eigen::Vector3d::Ones();
    if (direction.isZero()) continue;
    const double difference =
        FindSupportPoint(body, direction).extent - FindSupportPoint(other, direction).extent;
    if (std::abs(difference) > kTolerance * MeanHalfAxis(body) * direction.norm()) return false;
  }
  return true;
}

}  // namespace

bool ObjectMinimum::IsAboveLowest() const {
  return cost - lowest_cost > std::max(0.1, 1e-3 * cost);
}

std::vector<ObjectMinimum> CheckMinima(const BackEndInput& input, const OptimiseOptions& options,
                                       int threads) {
  std::vector<std::optional<ObjectMinimum>> minima(input.initial_landmarks.size());
  ParallelFor("objects", minima.size(), threads, [&](size_t i) {
    if (!input.initial_landmarks[i]) return;
    const Landmark& in_map = *input.initial_landmarks[i];
    // Residuals of the second solve are made for the landmark of the first.
    const auto minimum_near = [&](const Landmark& start) {
      const auto first = OptimiseObject(input, i, start, options);
      return first ? OptimiseObject(input, i, first->landmark_in_world, options) : std::nullopt;
    };
    const auto from_map = minimum_near(in_map);
    if (!from_map) return;
    minima[i] = {static_cast<int>(i), from_map->cost, from_map->cost, from_map->landmark_in_world};
    for (int k = 0; k < kYaws; ++k) {
      for (const double scale : kScales) {
        // The body scaled about the middle of its foot, and turned about its z axis.
        Landmark start = RotatedAboutZ(in_map, k * std::numbers::pi / kYaws);
        const Eigen::Vector3d up = in_map.frame_from_object.rotation * Eigen::Vector3d::UnitZ();
        start.half_axes *= scale;
        start.frame_from_object.translation += (scale - 1.0) * in_map.half_axes.z() * up;
        const auto found = minimum_near(start);
        if (!found || !(found->cost < minima[i]->lowest_cost)) continue;
        if (AreSame(from_map->landmark_in_world, found->landmark_in_world)) continue;
        minima[i]->lowest_cost = found->cost;
        minima[i]->lowest_in_world = found->landmark_in_world;
      }
    }
  });
  std::vector<ObjectMinimum> found;
  for (const auto& minimum : minima) {
    if (minimum) found.push_back(*minimum);
  }
  return found;
}

}  // namespace soslam

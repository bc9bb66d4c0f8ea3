// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/check_minima.h"

#include <algorithm>
#include <numbers>
#include <optional>

#include "base/error.h"
#include "base/parallel.h"

namespace soslam {
namespace {

constexpr int kYaws = 8;
constexpr double kScales[] = {0.8, 1.25};

// The body scaled about the middle of its foot, and turned about its z axis.
Landmark ScaledAndTurned(const Landmark& body, double scale, double turn) {
  Landmark moved = RotatedAboutZ(body, turn);
  const Eigen::Vector3d up = body.frame_from_object.rotation * Eigen::Vector3d::UnitZ();
  moved.half_axes *= scale;
  moved.frame_from_object.translation += (scale - 1.0) * body.half_axes.z() * up;
  return moved;
}

struct Solved {
  Landmark landmark_in_world;
  double cost;
};

// The minimum near a start, and its cost with residuals made for it. None where there is none.
std::optional<Solved> SolveFrom(BackEndInput input, size_t index, const Landmark& start,
                                const OptimiseOptions& options) {
  std::ranges::fill(input.initial_landmarks, std::nullopt);
  Solved at{start, 0.0};
  for (int round = 0; round < 2; ++round) {
    input.initial_landmarks[index] = at.landmark_in_world;
    try {
      const MapEstimate map = OptimiseMap(input, options);
      if (!map.objects[index].landmark_in_world) return std::nullopt;
      at = {*map.objects[index].landmark_in_world, map.solver.final_cost};
    } catch (const NumericalError&) {
      return std::nullopt;
    }
  }
  return at;
}

}  // namespace

bool ObjectMinimum::IsAboveLowest() const {
  return cost - lowest_cost > std::max(0.1, 1e-3 * cost);
}

std::vector<ObjectMinimum> CheckMinima(const BackEndInput& input, const OptimiseOptions& options,
                                       int threads) {
  OptimiseOptions alone = options;
  alone.hold_poses = true;
  alone.refine_planes = false;
  alone.covariances = false;
  std::vector<std::optional<ObjectMinimum>> minima(input.initial_landmarks.size());
  ParallelFor("objects", static_cast<int>(minima.size()), threads, [&](int index) {
    const auto i = static_cast<size_t>(index);
    if (!input.initial_landmarks[i]) return;
    const Landmark& in_map = *input.initial_landmarks[i];
    const auto from_map = SolveFrom(input, i, in_map, alone);
    if (!from_map) return;
    minima[i] = {index, from_map->cost, from_map->cost, from_map->landmark_in_world};
    for (int k = 0; k < kYaws; ++k) {
      for (const double scale : kScales) {
        const Landmark start = ScaledAndTurned(in_map, scale, k * std::numbers::pi / kYaws);
        const auto found = SolveFrom(input, i, start, alone);
        if (!found || !(found->cost < minima[i]->lowest_cost)) continue;
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

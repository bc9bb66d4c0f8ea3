// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/check_minima.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"

namespace soslam {
namespace {

constexpr int kYaws = 8;
constexpr double kScales[] = {0.8, 1.25};

struct Solved {
  Landmark landmark_in_world;
  double cost;
  double cost_of_start;  // without images
};

// The minimum near a start; in all rounds but the first, residuals are made for the landmark of the
// round before. None where there is none.
std::optional<Solved> SolveFrom(BackEndInput input, size_t index, const Landmark& start,
                                const OptimiseOptions& options, int rounds = 2) {
  std::ranges::fill(input.initial_landmarks, std::nullopt);
  Solved at{start, 0.0, 0.0};
  for (int round = 0; round < rounds; ++round) {
    input.initial_landmarks[index] = at.landmark_in_world;
    try {
      const MapEstimate map = OptimiseMap(input, options);
      if (!map.objects[index].landmark_in_world) return std::nullopt;
      at = {*map.objects[index].landmark_in_world, map.solver.final_cost, map.solver.initial_cost};
    } catch (const NumericalError&) {
      return std::nullopt;
    }
  }
  return at;
}

// Whether the x axes are more than an eighth of a turn apart, modulo half a turn.
bool IsTurned(const Landmark& body, const Landmark& other) {
  const auto x_axis = [](const Landmark& landmark) -> Eigen::Vector3d {
    return landmark.frame_from_object.rotation * Eigen::Vector3d::UnitX();
  };
  return std::abs(x_axis(body).dot(x_axis(other))) < std::numbers::sqrt2 / 2.0;
}

OptimiseOptions AloneOptions(OptimiseOptions options) {
  options.hold_poses = true;
  options.refine_planes = false;
  options.covariances = false;
  options.check_inputs = false;
  return options;
}

}  // namespace

bool ObjectMinimum::IsAboveLowest() const {
  return cost - lowest_cost > std::max(0.1, 1e-3 * cost);
}

std::vector<ObjectMinimum> CheckMinima(const BackEndInput& input, const OptimiseOptions& options,
                                       int threads) {
  const OptimiseOptions alone = AloneOptions(options);
  std::vector<std::optional<ObjectMinimum>> minima(input.initial_landmarks.size());
  ParallelFor("objects", minima.size(), threads, [&](size_t i) {
    if (!input.initial_landmarks[i]) return;
    const Landmark& in_map = *input.initial_landmarks[i];
    const auto from_map = SolveFrom(input, i, in_map, alone);
    if (!from_map) return;
    minima[i] = {static_cast<int>(i), from_map->cost, from_map->cost, from_map->landmark_in_world};
    for (int k = 0; k < kYaws; ++k) {
      for (const double scale : kScales) {
        // The body scaled about the middle of its foot, and turned about its z axis.
        Landmark start = RotatedAboutZ(in_map, k * std::numbers::pi / kYaws);
        const Eigen::Vector3d up = in_map.frame_from_object.rotation * Eigen::Vector3d::UnitZ();
        start.half_axes *= scale;
        start.frame_from_object.translation += (scale - 1.0) * in_map.half_axes.z() * up;
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

std::vector<std::optional<double>> QuarterTurnProbabilities(const BackEndInput& input,
                                                            const OptimiseOptions& options,
                                                            double dispersion, int threads) {
  const OptimiseOptions alone = AloneOptions(options);
  std::vector<std::optional<double>> probabilities(input.initial_landmarks.size());
  ParallelFor("quarter turns", probabilities.size(), threads, [&](size_t i) {
    if (!input.initial_landmarks[i]) return;
    const Landmark& in_map = *input.initial_landmarks[i];
    Landmark turned = RotatedAboutZ(in_map, 0.5 * std::numbers::pi);
    std::swap(turned.half_axes.x(), turned.half_axes.y());
    const auto as_in_map = SolveFrom(input, i, in_map, alone, 1);
    const auto as_turned = SolveFrom(input, i, turned, alone, 1);
    if (!as_in_map) return;
    probabilities[i] = 0.0;
    if (!as_turned) return;
    const bool is_minimum = IsTurned(as_in_map->landmark_in_world, as_turned->landmark_in_world);
    const double gain = is_minimum ? as_in_map->cost - as_turned->cost
                                   : as_in_map->cost_of_start - as_turned->cost_of_start;
    probabilities[i] = 1.0 / (1.0 + std::exp(-gain / dispersion));
  });
  return probabilities;
}

}  // namespace soslam

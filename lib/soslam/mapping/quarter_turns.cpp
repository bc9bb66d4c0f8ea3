// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/mapping/quarter_turns.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "soslam/base/parallel.h"

namespace soslam {

std::vector<std::optional<double>> QuarterTurnProbabilities(const BackEndInput& input,
                                                            const OptimiseOptions& options,
                                                            double dispersion, int threads) {
  std::vector<std::optional<double>> probabilities(input.initial_landmarks.size());
  ParallelFor("quarter turns", probabilities.size(), threads, [&](size_t i) {
    if (!input.initial_landmarks[i]) return;
    const Landmark& in_map = *input.initial_landmarks[i];
    Landmark turned = RotatedAboutZ(in_map, 0.5 * std::numbers::pi);
    std::swap(turned.half_axes.x(), turned.half_axes.y());
    const auto as_in_map = OptimiseObject(input, i, in_map, options);
    if (!as_in_map) return;
    probabilities[i] = 0.0;
    const auto as_turned = OptimiseObject(input, i, turned, options);
    if (!as_turned) return;
    const auto x_axis = [](const OptimisedObject& object) -> Eigen::Vector3d {
      return object.landmark_in_world.frame_from_object.rotation * Eigen::Vector3d::UnitX();
    };
    // They are two minima if their x axes are more than an eighth of a turn apart.
    const bool is_minimum =
        std::abs(x_axis(*as_in_map).dot(x_axis(*as_turned))) < std::numbers::sqrt2 / 2.0;
    const double gain = is_minimum ? as_in_map->cost - as_turned->cost
                                   : as_in_map->cost_of_start - as_turned->cost_of_start;
    probabilities[i] = 1.0 / (1.0 + std::exp(-gain / dispersion));
  });
  return probabilities;
}

}  // namespace soslam

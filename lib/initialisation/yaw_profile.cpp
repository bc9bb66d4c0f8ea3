// SPDX-License-Identifier: BSD-3-Clause
// The curve of the cost over yaw.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "geometry/angles.h"
#include "initialisation/fit_object.h"

namespace soslam {
namespace {

// Yaws farther apart than this many steps of the grid have a yaw without a landmark between them.
constexpr double kGap = 1.5;
// Number of integration steps of the likelihood between two yaws of the grid.
constexpr int kLikelihoodSteps = 100;

// Integrals of exp(-height^2) between two angles from -pi/2 to pi, with the height linear in the
// angle: mass, and second moment about 0 modulo pi.
struct Likelihood {
  double mass = 0.0;
  double squares = 0.0;
};
void AddInterval(const std::array<double, 2>& angles, const std::array<double, 2>& heights,
                 Likelihood* sum) {
  const auto [from, to] = angles;
  const auto [from_height, to_height] = heights;
  const double step = (to - from) / kLikelihoodSteps;
  for (int k = 0; k < kLikelihoodSteps; ++k) {
    const double share = (k + 0.5) / kLikelihoodSteps;
    const double height = from_height + share * (to_height - from_height);
    const double angle = from + share * (to - from);
    const double distance = angle < std::numbers::pi / 2.0 ? angle : std::numbers::pi - angle;
    const double density = std::exp(-height * height);
    sum->mass += step * density;
    sum->squares += step * density * distance * distance;
  }
}

}  // namespace

std::vector<double> YawProfile::Costs() const {
  std::vector<double> costs;
  for (const auto& fit : fits) {
    costs.push_back(fit ? fit->cost.total : std::numeric_limits<double>::quiet_NaN());
  }
  return costs;
}

double YawProfile::StandardDeviation(const std::vector<Optimum>& optima) const {
  // Nodes sorted by their signed distance from the first optimum, over half a turn. Between them
  // the square root of the cost above the lowest is taken as linear, which is exact for a Gaussian
  // of any width.
  const double centre = optima.front().yaw;
  std::vector<std::pair<double, double>> nodes;
  for (const Optimum& optimum : optima) {
    nodes.emplace_back(YawDifferenceModuloPi(optimum.yaw, centre), optimum.cost);
  }
  const double step = Step();
  int yaws_beside = 0;  // of the grid, including the one that was refined
  for (size_t i = 0; i < yaw.size(); ++i) {
    if (!fits[i]) continue;
    nodes.emplace_back(YawDifferenceModuloPi(yaw[i], centre), fits[i]->cost.total);
    if (std::abs(nodes.back().first) < kGap * step) ++yaws_beside;
  }
  std::sort(nodes.begin(), nodes.end());
  double lowest = std::numeric_limits<double>::infinity();
  for (const auto& [at, cost] : nodes) lowest = std::min(lowest, cost);
  nodes.emplace_back(nodes.front().first + std::numbers::pi, nodes.front().second);

  const auto height = [&](double cost) { return std::sqrt(cost - lowest); };
  Likelihood likelihood;
  for (size_t i = 1; i < nodes.size(); ++i) {
    const auto& [from, from_cost] = nodes[i - 1];
    const auto& [to, to_cost] = nodes[i];
    if (to - from > kGap * step) continue;
    AddInterval({from, to}, {height(from_cost), height(to_cost)}, &likelihood);
  }
  if (yaws_beside <= 1) {  // alone, it stands for the step around it
    const double of_first = height(optima.front().cost);
    AddInterval({-0.5 * step, 0.5 * step}, {of_first, of_first}, &likelihood);
  }
  return std::sqrt(likelihood.squares / likelihood.mass);
}

double YawProfile::Step() const { return std::numbers::pi / static_cast<double>(yaw.size()); }

std::vector<Landmark> YawProfile::Minima(size_t count) const {
  constexpr size_t kLeast = 6;
  std::vector<Landmark> minima;
  for (const size_t i : CircularMinima(Costs())) {
    if (minima.size() == std::max(count, kLeast)) break;
    minima.push_back(fits[i]->landmark);
  }
  return minima;
}

std::vector<size_t> CircularMinima(const std::vector<double>& values) {
  const size_t n = values.size();
  const auto height = [&](size_t i) {
    const double value = values[i < n ? i : i - n];
    return std::isnan(value) ? std::numeric_limits<double>::infinity() : value;
  };
  std::vector<size_t> minima;
  for (size_t i = 0; i < n; ++i) {
    // A plateau counts by its first index, a constant curve by index 0.
    if (!std::isfinite(height(i)) || (i > 0 && height(i) == height(i - 1))) continue;
    size_t end = i + 1;
    while (end < i + n && height(end) == height(i)) ++end;
    const bool is_constant = end == i + n;
    if (is_constant || (height(end) > height(i) && height(i) < height(i + n - 1))) {
      minima.push_back(i);
    }
  }
  std::ranges::stable_sort(minima, {}, height);
  return minima;
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/yaw_sweep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>

#include "geometry/angles.h"
#include "initialisation/closed_form.h"

namespace soslam {
namespace {

// Optima closer than this are the same.
constexpr double kSameOptimumYaw = 0.5 * kRadPerDeg;
// At least so many of the lowest minima of a sweep are refined: any of them may become the best
// one.
constexpr size_t kRefinedMinima = 6;
// Number of times that the step of the grid is halved about a minimum.
constexpr int kHalvings = 4;
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

// Fits landmarks to an observation and an objective.
class Fitter {
 public:
  Fitter(const UprightObservation& observation, const YawObjective& objective)
      : observation_(observation), objective_(objective), ground_(observation.plane_in_camera) {}

  // Repeats the fit, each time with costs made for the last result; the cost returned is that of
  // the result with the costs made for it.
  std::optional<UprightFit> Fit(const UprightVector& start, bool yaw_is_free) const {
    UprightSolution at{LandmarkAt(start), 0.0};
    for (int round = 0; round < objective_.rounds; ++round) {
      LandmarkCosts costs = ObservationTerms(observation_, at.landmark);
      std::ranges::move(FittedCosts(at.landmark), std::back_inserter(costs));
      const auto solution =
          FitUpright(observation_.plane_in_camera, at.landmark, costs, yaw_is_free);
      if (!solution || !IsInFront(solution->landmark)) return std::nullopt;
      at = *solution;
    }
    UprightFit fit{ground_.ParametersOf(at.landmark), at.cost};
    if (objective_.rounds > 1) {
      fit.fitted_cost = TotalCost(FittedCosts(at.landmark), at.landmark);
      fit.cost =
          TotalCost(ObservationTerms(observation_, at.landmark), at.landmark) + fit.fitted_cost;
    }
    if (objective_.compared_cost) fit.compared_cost = objective_.compared_cost(at.landmark);
    fit.cost += fit.compared_cost;
    return fit;
  }

  // The best landmark near a grid point. Without a compared cost the fit optimises the yaw; with
  // one, the neighbours on ever finer grids are compared.
  std::optional<UprightFit> RefineYaw(const UprightFit& grid_point, double step) const {
    if (!objective_.compared_cost) return Fit(grid_point.parameters, /*yaw_is_free=*/true);
    UprightFit best = grid_point;
    for (int i = 0; i < kHalvings; ++i) {
      step /= 2.0;
      const UprightVector centre = best.parameters;
      for (const double turn : {-step, step}) {
        UprightVector at = centre;
        at[0] += turn;
        const auto fit = Fit(at, /*yaw_is_free=*/false);
        if (fit && fit->cost < best.cost) best = *fit;
      }
    }
    return best;
  }

  // The upright landmark tilted to where its cost is lowest.
  UprightSolution Lean(const UprightSolution& upright) const {
    Landmark at = upright.landmark;
    for (int round = 0; round < objective_.rounds; ++round) {
      const auto tilted = FitLeaning(observation_.plane_in_camera, at, LeaningCosts(at));
      if (!tilted || !IsInFront(tilted->landmark)) return upright;
      at = tilted->landmark;
    }
    double cost = TotalCost(LeaningCosts(at), at);
    if (objective_.compared_cost) cost += objective_.compared_cost(at);
    return cost < upright.cost ? UprightSolution{at, cost} : upright;
  }

  Landmark LandmarkAt(const UprightVector& parameters) const {
    return ground_.LandmarkAt(parameters, observation_.prior.shape_exponents,
                              observation_.prior.rests_on);
  }

 private:
  LandmarkCosts FittedCosts(const Landmark& start) const {
    return objective_.fitted_costs ? objective_.fitted_costs(start) : LandmarkCosts();
  }

  LandmarkCosts LeaningCosts(const Landmark& start) const {
    LandmarkCosts costs = ObservationTerms(observation_, start);
    std::ranges::move(FittedCosts(start), std::back_inserter(costs));
    costs.push_back(std::make_unique<LeaningTerm>(observation_.plane_in_camera));
    return costs;
  }

  const UprightObservation& observation_;
  const YawObjective& objective_;
  UprightGround ground_;
};

}  // namespace

std::string WhyNoSolution(const UprightObservation& observation) {
  return ClosedForm(observation).HasEnoughEdges() ? "no_solution"
                                                  : "fewer_than_three_measured_edges";
}

std::vector<double> YawSweep::Costs() const {
  std::vector<double> costs;
  for (const auto& fit : fits) {
    costs.push_back(fit ? fit->cost : std::numeric_limits<double>::quiet_NaN());
  }
  return costs;
}

double YawSweep::StandardDeviation(const std::vector<Optimum>& optima) const {
  // Nodes sorted by their signed distance from the first optimum, over half a turn. Between them
  // the square root of the cost above the lowest is taken as linear, which is exact for a Gaussian
  // of any width.
  const double centre = optima.front().yaw;
  std::vector<std::pair<double, double>> nodes;
  for (const Optimum& optimum : optima) {
    nodes.emplace_back(YawDifferenceModuloPi(optimum.yaw, centre), optimum.cost);
  }
  const double step = std::numbers::pi / static_cast<double>(yaw.size());
  int yaws_beside = 0;  // of the grid, including the one that was refined
  for (size_t i = 0; i < yaw.size(); ++i) {
    if (!fits[i]) continue;
    nodes.emplace_back(YawDifferenceModuloPi(yaw[i], centre), fits[i]->cost);
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

YawSweep SweepYaw(const UprightObservation& observation, const YawObjective& objective,
                  double step) {
  YawSweep sweep;
  const int steps = std::max(1, static_cast<int>(std::lround(std::numbers::pi / step)));
  for (int i = 0; i < steps; ++i) sweep.yaw.push_back(i * std::numbers::pi / steps);
  const ClosedForm closed_form(observation);
  const Fitter fitter(observation, objective);
  for (const double yaw : sweep.yaw) {
    const auto start = closed_form.At(yaw);
    sweep.fits.push_back(start ? fitter.Fit(*start, /*yaw_is_free=*/false) : std::nullopt);
  }
  return sweep;
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

std::vector<UprightSolution> LocalOptima(const UprightObservation& observation,
                                         const YawObjective& objective, const YawSweep& sweep,
                                         size_t max_count) {
  const double step = std::numbers::pi / static_cast<double>(sweep.yaw.size());
  const auto yaw_of = [](const UprightFit& fit) {
    return std::remainder(fit.parameters[0], 2.0 * std::numbers::pi);
  };
  const Fitter fitter(observation, objective);
  std::vector<UprightFit> optima;
  std::vector<size_t> minima = CircularMinima(sweep.Costs());
  minima.resize(std::min(minima.size(), std::max(max_count, kRefinedMinima)));
  for (const size_t i : minima) {
    const auto fit = fitter.RefineYaw(*sweep.fits[i], step);
    if (!fit) continue;
    const bool known = std::ranges::any_of(optima, [&](const auto& other) {
      return std::abs(YawDifferenceModuloPi(yaw_of(*fit), yaw_of(other))) < kSameOptimumYaw;
    });
    if (!known) optima.push_back(*fit);
  }
  // An object with a = b has two yaws of the same cost: they are sorted by yaw, not by rounding
  // errors of the costs.
  const auto rank = [&](const UprightFit& fit) {
    return std::pair(RankOfCost(fit.cost), yaw_of(fit));
  };
  std::ranges::sort(optima, {}, rank);
  optima.resize(std::min(optima.size(), max_count));
  std::vector<UprightSolution> solutions;
  for (const UprightFit& fit : optima) {
    solutions.push_back({fitter.LandmarkAt(fit.parameters), fit.cost});
    if (observation.prior.attitude == Attitude::kFree) {
      solutions.back() = fitter.Lean(solutions.back());
    }
  }
  std::ranges::stable_sort(solutions, {}, [](const auto& one) { return RankOfCost(one.cost); });
  return solutions;
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/initialisation/fit_object.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "soslam/geometry/angles.h"
#include "soslam/initialisation/body_at_yaw.h"

namespace soslam {
namespace {

// Tangent depths, and what of an image counts, depend on the linearisation point: fitted twice.
constexpr int kRounds = 2;
// Landmarks of one object with yaws closer than this are the same.
constexpr double kSameOptimumYaw = 0.5 * kRadPerDeg;
// Number of times that the step of a profile is halved about a minimum.
constexpr int kHalvings = 4;
constexpr double kNoLimit = std::numeric_limits<double>::infinity();

double ComputeYaw(const ObjectEvidence& evidence, const Landmark& landmark) {
  return Yaw(evidence.plane.normal, landmark.frame_from_object.rotation);
}

// The landmark near the start that fits best, at the start's yaw or any. See EvaluateCost for the
// limit.
std::optional<ObjectFit> Fit(const ObjectEvidence& evidence, const Landmark& start,
                             bool yaw_is_free, double limit) {
  Landmark at = start;
  for (int round = 0; round < kRounds; ++round) {
    const auto solution = FitUpright(evidence.plane, at, CostsAt(evidence, at),
                                     {.yaw = yaw_is_free, .height = evidence.height_is_free},
                                     evidence.tolerance.cost);
    if (!solution) return std::nullopt;
    at = solution->landmark;
  }
  return ObjectFit{at, EvaluateCost(evidence, at, limit)};
}

// The best of the yaws on ever finer grids about the start.
std::optional<ObjectFit> FitByComparison(const ObjectEvidence& evidence, const Landmark& start,
                                         double step) {
  std::optional<ObjectFit> best = Fit(evidence, start, /*yaw_is_free=*/false, kNoLimit);
  for (int i = 0; best && i < kHalvings; ++i) {
    step /= 2.0;
    const Landmark centre = best->landmark;
    for (const double turn : {-step, step}) {
      const auto fit =
          Fit(evidence, RotatedAboutZ(centre, turn), /*yaw_is_free=*/false, best->cost.total);
      if (fit && fit->cost.total < best->cost.total) best = fit;
    }
  }
  return best;
}

// The upright landmark tilted to where its cost is lowest.
ObjectFit Leaning(const ObjectEvidence& evidence, const ObjectFit& upright) {
  Landmark at = upright.landmark;
  for (int round = 0; round < kRounds; ++round) {
    const auto tilted = FitLeaning(evidence.plane, at, CostsAt(evidence, at));
    if (!tilted) return upright;
    at = tilted->landmark;
  }
  const ObjectFit leaning{at, EvaluateCost(evidence, at)};
  return leaning.cost.total < upright.cost.total ? leaning : upright;
}

void SortByRank(std::vector<ObjectFit>* fits, size_t max_hypotheses) {
  std::ranges::stable_sort(*fits, {},
                           [](const ObjectFit& fit) { return RankOfCost(fit.cost.total); });
  if (fits->size() > max_hypotheses) fits->resize(max_hypotheses);
}

// Yaws farther apart than this many steps of the grid have a yaw without a landmark between them.
constexpr double kGap = 1.5;
// Number of integration steps of the likelihood between two yaws of the grid.
constexpr int kLikelihoodSteps = 100;

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

  // Integrals of exp(-height^2), with the height linear in the angle between two angles from -pi/2
  // to pi: mass, and second moment about 0 modulo pi.
  double mass = 0.0, squares = 0.0;
  const auto add_interval = [&](double from, double from_cost, double to, double to_cost) {
    const double from_height = std::sqrt(from_cost - lowest);
    const double to_height = std::sqrt(to_cost - lowest);
    const double width = (to - from) / kLikelihoodSteps;
    for (int k = 0; k < kLikelihoodSteps; ++k) {
      const double share = (k + 0.5) / kLikelihoodSteps;
      const double height = from_height + share * (to_height - from_height);
      const double angle = from + share * (to - from);
      const double distance = angle < std::numbers::pi / 2.0 ? angle : std::numbers::pi - angle;
      const double density = std::exp(-height * height);
      mass += width * density;
      squares += width * density * distance * distance;
    }
  };
  for (size_t i = 1; i < nodes.size(); ++i) {
    const auto& [from, from_cost] = nodes[i - 1];
    const auto& [to, to_cost] = nodes[i];
    if (to - from > kGap * step) continue;
    add_interval(from, from_cost, to, to_cost);
  }
  if (yaws_beside <= 1) {  // alone, it stands for the step around it
    add_interval(-0.5 * step, optima.front().cost, 0.5 * step, optima.front().cost);
  }
  return std::sqrt(squares / mass);
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

double FirstYaw(const ObjectEvidence& evidence) {
  const Eigen::Vector3d& normal = evidence.plane.normal;
  const Eigen::Quaterniond& camera_from_reference =
      evidence.views.front().camera_from_reference.rotation;
  return Yaw(normal, camera_from_reference.conjugate() *
                         UprightRotation(camera_from_reference * normal, 0.0));
}

YawProfile ProfileOverYaw(const ObjectEvidence& evidence, double step) {
  const double first_yaw = FirstYaw(evidence);
  const int steps = std::max(1, static_cast<int>(std::lround(std::numbers::pi / step)));
  const bool is_linear = evidence.further.empty() && !evidence.compared_cost;
  const BodyAtYaw body_at(evidence);
  YawProfile profile;
  for (int i = 0; i < steps; ++i) {
    profile.yaw.push_back(first_yaw + i * std::numbers::pi / steps);
    const auto start = body_at.Solve(profile.yaw.back());
    profile.fits.emplace_back();
    if (!start) continue;
    profile.fits.back() = is_linear ? ObjectFit{*start, EvaluateCost(evidence, *start)}
                                    : Fit(evidence, *start, /*yaw_is_free=*/false, kNoLimit);
  }
  return profile;
}

std::vector<ObjectFit> FitObject(const ObjectEvidence& evidence,
                                 const std::vector<Landmark>& starts, const FitOptions& options) {
  std::vector<ObjectFit> fits;
  double lowest = kNoLimit;
  for (const Landmark& start : starts) {
    const bool by_comparison = evidence.compared_cost && options.compared_step > 0.0;
    const auto fit = by_comparison ? FitByComparison(evidence, start, options.compared_step)
                                   : Fit(evidence, start, /*yaw_is_free=*/true,
                                         options.max_hypotheses == 1 ? lowest : kNoLimit);
    if (!fit || !std::isfinite(fit->cost.total)) continue;
    lowest = std::min(lowest, fit->cost.total);
    const bool is_known = std::ranges::any_of(fits, [&](const ObjectFit& other) {
      return std::abs(YawDifferenceModuloPi(ComputeYaw(evidence, fit->landmark),
                                            ComputeYaw(evidence, other.landmark))) <
             kSameOptimumYaw;
    });
    if (!is_known) fits.push_back(*fit);
  }
  // An object with a = b has two yaws of the same cost: they are sorted by yaw, not by rounding
  // errors of the costs.
  std::ranges::sort(fits, {}, [&](const ObjectFit& fit) {
    return std::pair(RankOfCost(fit.cost.total), ComputeYaw(evidence, fit.landmark));
  });
  SortByRank(&fits, options.max_hypotheses);
  if (evidence.MayLean()) {
    for (ObjectFit& fit : fits) fit = Leaning(evidence, fit);
    SortByRank(&fits, options.max_hypotheses);
  }
  return fits;
}

std::vector<ObjectFit> FitObject(const ObjectEvidence& evidence, double yaw_step,
                                 size_t max_hypotheses) {
  std::vector<std::vector<ObjectFit>> on_faces;
  for (const ObjectEvidence& on_face : OnEachFace(evidence)) {
    const YawProfile profile = ProfileOverYaw(on_face, yaw_step);
    on_faces.push_back(
        FitObject(on_face, profile.Minima(max_hypotheses), {max_hypotheses, profile.Step()}));
  }
  return MergeFits(std::move(on_faces), max_hypotheses);
}

std::vector<ObjectEvidence> OnEachFace(const ObjectEvidence& evidence) {
  std::vector<ObjectEvidence> on_faces;
  for (const auto& prior : OnPossibleFaces(evidence.prior)) {
    on_faces.push_back(evidence);
    on_faces.back().prior = prior;
  }
  return on_faces;
}

std::vector<ObjectFit> MergeFits(std::vector<std::vector<ObjectFit>> on_faces,
                                 size_t max_hypotheses) {
  std::vector<ObjectFit> joined;
  for (std::vector<ObjectFit>& fits : on_faces) std::ranges::move(fits, std::back_inserter(joined));
  SortByRank(&joined, max_hypotheses);
  return joined;
}

}  // namespace soslam

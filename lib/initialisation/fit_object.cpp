// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/fit_object.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "geometry/angles.h"
#include "initialisation/body_at_yaw.h"

namespace soslam {
namespace {

// Tangent depths, and what of an image counts, depend on the linearisation point: fitted twice.
constexpr int kRounds = 2;
// Landmarks of one object with yaws closer than this are the same.
constexpr double kSameOptimumYaw = 0.5 * kRadPerDeg;
// Number of times that the step of a profile is halved about a minimum.
constexpr int kHalvings = 4;
constexpr double kNoLimit = std::numeric_limits<double>::infinity();

double YawOf(const ObjectEvidence& evidence, const Landmark& landmark) {
  return Yaw(evidence.plane.normal, landmark.frame_from_object.rotation);
}

// The landmark near the start that fits best, at the start's yaw or any. See CostOf for the limit.
std::optional<ObjectFit> Fit(const ObjectEvidence& evidence, const Landmark& start,
                             bool yaw_is_free, double limit) {
  Landmark at = start;
  for (int round = 0; round < kRounds; ++round) {
    const auto solution = FitUpright(evidence.plane, at, CostsAt(evidence, at),
                                     {.yaw = yaw_is_free, .height = evidence.height_is_free});
    if (!solution) return std::nullopt;
    at = solution->landmark;
  }
  return ObjectFit{at, CostOf(evidence, at, limit)};
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
  const ObjectFit leaning{at, CostOf(evidence, at)};
  return leaning.cost.total < upright.cost.total ? leaning : upright;
}

void SortByRank(std::vector<ObjectFit>* fits, size_t max_hypotheses) {
  std::ranges::stable_sort(*fits, {},
                           [](const ObjectFit& fit) { return RankOfCost(fit.cost.total); });
  if (fits->size() > max_hypotheses) fits->resize(max_hypotheses);
}

}  // namespace

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
    profile.fits.back() = is_linear ? ObjectFit{*start, CostOf(evidence, *start)}
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
      return std::abs(YawDifferenceModuloPi(YawOf(evidence, fit->landmark),
                                            YawOf(evidence, other.landmark))) < kSameOptimumYaw;
    });
    if (!is_known) fits.push_back(*fit);
  }
  // An object with a = b has two yaws of the same cost: they are sorted by yaw, not by rounding
  // errors of the costs.
  std::ranges::sort(fits, {}, [&](const ObjectFit& fit) {
    return std::pair(RankOfCost(fit.cost.total), YawOf(evidence, fit.landmark));
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
  return Joined(std::move(on_faces), max_hypotheses);
}

std::vector<ObjectEvidence> OnEachFace(const ObjectEvidence& evidence) {
  std::vector<ObjectEvidence> on_faces;
  for (const auto& prior : OnPossibleFaces(evidence.prior)) {
    on_faces.push_back(evidence);
    on_faces.back().prior = prior;
  }
  return on_faces;
}

std::vector<ObjectFit> Joined(std::vector<std::vector<ObjectFit>> on_faces, size_t max_hypotheses) {
  std::vector<ObjectFit> joined;
  for (std::vector<ObjectFit>& fits : on_faces) std::ranges::move(fits, std::back_inserter(joined));
  SortByRank(&joined, max_hypotheses);
  return joined;
}

}  // namespace soslam

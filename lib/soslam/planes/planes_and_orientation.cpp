// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/planes/planes_and_orientation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "soslam/base/error.h"
#include "soslam/planes/estimate_planes.h"
#include "soslam/planes/tilt_drift.h"

namespace soslam {
namespace {

constexpr double kSameAxis = 1e-9;  // one minus a cosine
// Hypotheses whose cost after the fit of bodies is higher than this are dropped before planes are
// estimated.
const double kMaxHypothesisCost = std::log(1e4);

struct Hypothesis {
  OrientationEvidence evidence;
  double expected_cost = 0.0;
  TiltCorrectedTrajectory trajectory;
  std::optional<PlanesAndOrientation> planes;
};

TiltCorrectedTrajectory MakeTrajectory(const Sequence& sequence,
                                       const std::vector<SegmentView>& views,
                                       const PlanesOptions& options,
                                       CameraOrientation orientation) {
  if (!views.empty()) return RemoveTiltDrift(views, orientation, options);
  const std::vector<Rigid3d> poses = PosesOf(sequence);
  return {poses,
          UpPriorFromCameras(poses, options.tilt, options.upright.ViewCorrelation(), orientation)};
}

Sequence WithPoses(Sequence sequence, const std::vector<Rigid3d>& world_from_camera) {
  for (size_t i = 0; i < sequence.frames.size(); ++i) {
    sequence.frames[i].world_from_camera = world_from_camera[i];
  }
  return sequence;
}

// Adds the hypothesis of one camera orientation with the costs of upright bodies of free height,
// unless an earlier hypothesis has the same up.
void AddHypothesis(const Sequence& sequence, const TiltCorrectedTrajectory& trajectory,
                   const OrientationEvidence& orientation,
                   const std::vector<std::optional<ShapePrior>>& priors,
                   const PlanesOptions& options, int threads, std::vector<Hypothesis>* hypotheses) {
  const Eigen::Vector3d& up = trajectory.up_prior.up_in_world;
  const bool is_known = std::ranges::any_of(*hypotheses, [&](const Hypothesis& other) {
    return IsSameUp(other.evidence.up_in_world, up);
  });
  if (is_known) return;
  Hypothesis hypothesis{orientation, 0.0, trajectory, std::nullopt};
  hypothesis.evidence.up_in_world = up;
  // Upright bodies have no up or down side: the costs of the opposite up direction are equal.
  const auto opposite = std::ranges::find_if(*hypotheses, [&](const Hypothesis& other) {
    return !(other.evidence.up_in_world.dot(-up) < 1.0 - kSameAxis);
  });
  if (opposite != hypotheses->end()) {
    hypothesis.evidence.object_costs = opposite->evidence.object_costs;
    hypothesis.expected_cost = opposite->expected_cost;
  } else {
    const BodyCosts costs = CostsOfUprightBodies(WithPoses(sequence, trajectory.world_from_camera),
                                                 priors, trajectory.up_prior, options, threads);
    hypothesis.evidence.object_costs = costs.of_objects;
    hypothesis.expected_cost = costs.expected;
  }
  hypotheses->push_back(std::move(hypothesis));
}

OrientationChoice Choose(const std::vector<Hypothesis>& hypotheses) {
  std::vector<OrientationEvidence> evidence;
  for (const Hypothesis& hypothesis : hypotheses) evidence.push_back(hypothesis.evidence);
  double expected_cost = 0.0;
  for (const Hypothesis& hypothesis : hypotheses) {
    expected_cost = std::max(expected_cost, hypothesis.expected_cost);
  }
  return ChooseOrientation(evidence, expected_cost);
}

// Estimates the planes of a hypothesis. If no object's views determine the height of its base, the
// hypothesis counts as having one plane and cannot be chosen.
void FollowHypothesis(const Sequence& sequence,
                      const std::vector<std::optional<ShapePrior>>& priors,
                      const PlanesOptions& options, int threads, Hypothesis* hypothesis) {
  PlanesAndOrientation held;
  held.level = WithPoses(sequence, hypothesis->trajectory.world_from_camera);
  auto estimate = FindPlanes(held.level, priors, hypothesis->trajectory.up_prior, options, threads);
  if (!estimate) {
    hypothesis->evidence.other_cost = options.new_plane_cost;
    hypothesis->evidence.can_be_chosen = false;
    return;
  }
  held.estimate = std::move(*estimate);
  OrientationEvidence& evidence = hypothesis->evidence;
  evidence.up_in_world = held.estimate.planes.front().plane_in_world.normal;
  for (size_t i = 0; i < evidence.object_costs.size(); ++i) {
    // A body of free height may not be found again when it must stand on its plane.
    const ObjectSupport& support = held.estimate.objects[i];
    if (support.cost || support.reason != SupportReason::kOwnHeight) {
      evidence.object_costs[i] = support.cost;
    }
  }
  evidence.other_cost = static_cast<double>(held.estimate.planes.size()) * options.new_plane_cost;
  int below = 0, seen = 0;
  for (const Detection& detection : held.level.detections) {
    const ObjectSupport& support = held.estimate.objects[detection.object_index];
    if (support.reason == SupportReason::kNone) continue;
    const Plane& plane = held.estimate.planes[support.plane_index].plane_in_world;
    const Rigid3d& camera = held.level.FrameOf(detection).world_from_camera;
    if (plane.SignedDistance(camera.translation) < 0.0) ++below;
    ++seen;
  }
  evidence.share_from_below = seen == 0 ? 0.0 : static_cast<double>(below) / seen;
  evidence.can_be_chosen = true;
  hypothesis->expected_cost = held.estimate.expected_cost;
  hypothesis->planes = std::move(held);
}

// True if the same orientation with its vertical edges leads to planes and fits bodies at no higher
// cost.
bool IsNoBetterWithoutVerticals(const std::vector<Hypothesis>& hypotheses, size_t doubting,
                                const std::vector<double>& costs_of_bodies) {
  const OrientationEvidence& evidence = hypotheses[doubting].evidence;
  if (!evidence.ignores_verticals) return false;
  for (size_t i = 0; i < doubting; ++i) {
    const OrientationEvidence& other = hypotheses[i].evidence;
    if (other.orientation != evidence.orientation || other.ignores_verticals) continue;
    return hypotheses[i].planes && costs_of_bodies[i] <= costs_of_bodies[doubting];
  }
  return false;
}

}  // namespace

void ThrowNoPlane(const std::string& sequence) {
  throw NothingUsableError(fmt::format(
      "{}: no object's boxes determine the height of the plane that it stands on or hangs from; "
      "expected an object seen from several places, or planes = given",
      sequence));
}

PlanesAndOrientation EstimatePlanesAndOrientation(
    const Sequence& sequence, const std::vector<SegmentView>& views,
    const std::vector<std::optional<ShapePrior>>& priors, const PlanesOptions& options,
    int threads) {
  std::vector<Hypothesis> hypotheses;
  for (const CameraOrientation orientation : kCameraOrientations) {
    OrientationEvidence evidence;
    evidence.orientation = orientation;
    AddHypothesis(sequence, MakeTrajectory(sequence, views, options, orientation), evidence, priors,
                  options, threads, &hypotheses);
    if (views.empty()) continue;
    // Vertical edges are doubted because, when all cameras look the same way, the up direction
    // around which they are searched is uncertain.
    evidence.ignores_verticals = true;
    AddHypothesis(sequence, MakeTrajectory(sequence, {}, options, orientation), evidence, priors,
                  options, threads, &hypotheses);
  }
  const OrientationChoice by_bodies = Choose(hypotheses);
  std::vector<TriedOrientation> tried;  // also those dropped for the cost of their bodies
  std::vector<Hypothesis> followed;
  std::vector<size_t> place_in_tried;  // of each followed one
  for (size_t i = 0; i < hypotheses.size(); ++i) {
    const OrientationEvidence& evidence = hypotheses[i].evidence;
    tried.push_back({evidence.orientation, !views.empty() && !evidence.ignores_verticals,
                     by_bodies.costs[i], 0.0, std::nullopt});
    if (by_bodies.costs[i] > kMaxHypothesisCost) continue;
    if (IsNoBetterWithoutVerticals(hypotheses, i, by_bodies.costs)) continue;
    FollowHypothesis(sequence, priors, options, threads, &hypotheses[i]);
    // Different orientations may converge to one up.
    const bool is_known = std::ranges::any_of(followed, [&](const Hypothesis& other) {
      return other.planes && hypotheses[i].planes &&
             IsSameUp(other.evidence.up_in_world, hypotheses[i].evidence.up_in_world);
    });
    if (is_known) continue;
    followed.push_back(hypotheses[i]);
    place_in_tried.push_back(i);
  }
  const bool has_planes = std::ranges::any_of(
      followed, [](const Hypothesis& hypothesis) { return hypothesis.planes.has_value(); });
  if (!has_planes) ThrowNoPlane(sequence.name);
  const OrientationChoice choice = Choose(followed);
  for (size_t i = 0; i < followed.size(); ++i) {
    TriedOrientation& one = tried[place_in_tried[i]];
    one.cost = choice.costs[i];
    one.probability = choice.probabilities[i];
    if (const auto& held = followed[i].planes) {
      one.planes = static_cast<int>(held->estimate.planes.size());
    }
  }
  PlanesAndOrientation best = *followed[choice.best].planes;
  best.estimate.orientation = tried[place_in_tried[choice.best]].orientation;
  best.estimate.verticals = tried[place_in_tried[choice.best]].verticals;
  best.estimate.orientation_tilt_variance = choice.tilt_variance;
  best.estimate.orientations = std::move(tried);
  return best;
}

}  // namespace soslam

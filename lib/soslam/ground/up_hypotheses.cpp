// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/ground/up_hypotheses.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "soslam/base/upper_median.h"
#include "soslam/geometry/angles.h"
#include "soslam/planes/camera_orientation.h"
#include "soslam/planes/turn_evidence.h"

namespace soslam {
namespace {

// The up prior with an error that all cameras and edges share: edges that are taken for vertical
// need not be.
UpPrior WithCommonError(const UpPrior& up_prior) {
  constexpr double kCommonError = 1.0 * kRadPerDeg;
  Eigen::Matrix2d covariance = TiltCovariance(up_prior);
  covariance.diagonal().array() += kCommonError * kCommonError;
  return WithTiltCovariance(up_prior.up_in_world, covariance);
}

// The scale by the settings. `on_lowest_plane`: a point on the lowest plane of points,
// whether or not objects stand on it.
std::vector<KnownScale> KnownScales(const NormalisedInput& input, const Eigen::Vector3d& up,
                                    const std::optional<Eigen::Vector3d>& on_lowest_plane) {
  const GroundOptions& options = input.options;
  std::vector<KnownScale> known;
  if (options.scale > 0.0) {
    known.push_back(
        {std::log(options.scale * input.units_per_input), options.scale_log_sigma, "scale"});
  }
  if (!(options.camera_height_m > 0.0) || !on_lowest_plane) return known;
  std::vector<double> heights;
  for (const Frame& frame : input.sequence.frames) {
    heights.push_back(up.dot(frame.world_from_camera.translation - *on_lowest_plane));
  }
  const double height = UpperMedian(std::move(heights));
  if (height > 0.0) {
    known.push_back({std::log(options.camera_height_m / height), options.camera_height_log_sigma,
                     "camera_height_m"});
  }
  return known;
}

// Negative log likelihood of what the detector finds in turned images.
double CostOfTurns(const NormalisedInput& input, const Eigen::Vector3d& up_in_world) {
  std::vector<TurnedScores> images;
  for (const TurnedImage& image : input.turned_images) {
    const Rigid3d& pose = input.sequence.frames[image.frame_index].world_from_camera;
    images.push_back({image.scores, pose.rotation.conjugate() * up_in_world});
  }
  return images.empty() ? 0.0 : -LogLikelihoodOfTurns(images);
}

// Estimates the scale from objects and the known scales, and adds those by measured objects to the
// known ones.
void TellScale(double same_label_correlation, UpHypothesis* hypothesis) {
  std::vector<MeasuredObject*> objects;
  for (MeasuredObject& object : hypothesis->objects) {
    if (!object.evidence.hypotheses.empty()) objects.push_back(&object);
  }
  const auto measured =
      std::stable_partition(objects.begin(), objects.end(),
                            [](const MeasuredObject* object) { return !object->size.Any(); });
  std::vector<ScaleEvidence> evidence;
  const auto add = [&](const MeasuredObject* object) { evidence.push_back(object->evidence); };
  std::for_each(objects.begin(), measured, add);
  WeightSameLabels(same_label_correlation, &evidence);
  hypothesis->scale_of_objects = EstimateScale(evidence, {});
  std::for_each(measured, objects.end(), add);
  hypothesis->scale = EstimateScale(evidence, hypothesis->known_scales);
  for (size_t i = 0; i < objects.size(); ++i) {
    objects[i]->evidence.weight = evidence[i].weight;
    objects[i]->pull = hypothesis->scale->pull[i];
    if (!objects[i]->size.Any()) continue;
    const auto shares = HypothesisProbabilities(evidence[i], hypothesis->scale->log_scale);
    const auto best = std::ranges::max_element(shares) - shares.begin();
    const ScaleHypothesis& taken = evidence[i].hypotheses[best];
    hypothesis->known_scales.push_back({taken.log_scale, taken.log_sigma, kSizeByHand});
  }
}

// Finds the planes of points of a hypothesis whose cameras and up priors are known.
void FindPlanesOfPoints(const NormalisedInput& input, UpHypothesis* hypothesis) {
  hypothesis->planes = FindHorizontalPlanes(input.points, hypothesis->up_prior);
  // Edges that are taken for vertical need not be: those of flat things, seen from above, or any
  // where all cameras look in one direction. Where planes of points are likelier without them, they
  // are ignored; where nearly as likely, up is ambiguous.
  if (hypothesis->verticals) {
    constexpr double kSameUp = 3.0 * kRadPerDeg;
    HorizontalPlanes& planes = hypothesis->planes;
    HorizontalPlanes other = FindHorizontalPlanes(input.points, hypothesis->without_verticals);
    const double angle = AngleBetween(planes.up_in_world, other.up_in_world);
    if (angle >= kSameUp && !other.planes.empty()) {
      const double gain = planes.gain, other_gain = other.gain;
      if (other_gain > gain) {
        std::swap(planes, other);
        hypothesis->up_prior = hypothesis->without_verticals;
        hypothesis->verticals = false;
      }
      const double weight = WeightOfGain(std::min(gain, other_gain), std::max(gain, other_gain));
      AddAmbiguity(weight / (1.0 + weight) * angle * angle, &planes);
    }
  }
  hypothesis->cost = hypothesis->cost_of_boxes + CostOfTurns(input, hypothesis->planes.up_in_world);
  if (hypothesis->cameras_are_turned) hypothesis->cost += kNotLevelCost;
}

// Negative log likelihood ratio of so many objects on support planes: with up as it is, against a
// wrong up. Shares of objects that stand are beta distributed, by 29 synthesised rooms and an
// earlier grouping of boxes (docs/planes.md); one scene in five is like none of them.
double CostOfSupport(double standing, double objects) {
  constexpr double kUnlikeRooms = 0.2;
  const auto log_probability = [&](double stands, double does_not) {
    const auto log_beta = [](double a, double b) {
      return std::lgamma(a) + std::lgamma(b) - std::lgamma(a + b);
    };
    return log_beta(standing + stands, objects - standing + does_not) - log_beta(stands, does_not);
  };
  const auto mixed = [&](double stands, double does_not) {
    const double like_rooms = log_probability(stands, does_not), even = log_probability(1.0, 1.0);
    const double most = std::max(like_rooms, even);
    return most + std::log((1.0 - kUnlikeRooms) * std::exp(like_rooms - most) +
                           kUnlikeRooms * std::exp(even - most));
  };
  return mixed(5.3, 23.7) - mixed(125.6, 17.0);
}

// Finds objects and scale of a hypothesis with planes, and leaves out planes without objects.
void FindObjects(const NormalisedInput& input, UpHypothesis* hypothesis) {
  HorizontalPlanes& planes = hypothesis->planes;
  hypothesis->planes_of_points = static_cast<int>(planes.planes.size());
  std::optional<Eigen::Vector3d> on_lowest_plane;
  if (!planes.planes.empty()) on_lowest_plane = planes.planes.front().centre_in_world;
  const std::vector<int> frames = FramesToGroup(input.sequence, input.edits);
  const std::vector<BoxGroup> groups = WithSizes(
      input.edits, GroupBoxes(input.sequence, frames, input.edits, input.table, input.pairs,
                              WithTiltCovariance(planes.up_in_world, planes.tilt_covariance),
                              input.options, input.threads));
  const auto measure = [&] {
    hypothesis->objects = MeasureObjects(input.sequence, frames, groups, input.table, planes,
                                         input.options, input.threads);
    hypothesis->known_scales = KnownScales(input, planes.up_in_world, on_lowest_plane);
    TellScale(input.options.same_label_correlation, hypothesis);
  };
  measure();
  constexpr double kLeastObjects = 0.5;
  const std::vector<double> objects_on = hypothesis->ObjectsOnPlanes();
  std::vector<PlaneOfPoints> with_objects;
  for (size_t k = 0; k < objects_on.size(); ++k) {
    if (objects_on[k] >= kLeastObjects) with_objects.push_back(planes.planes[k]);
  }
  if (with_objects.size() < planes.planes.size()) {
    planes.planes = with_objects;
    planes = Refined(planes, input.points, hypothesis->up_prior);
    measure();
  }
  hypothesis->cost +=
      CostOfSupport(hypothesis->StandingObjects(), static_cast<double>(hypothesis->objects.size()));
}

// Cameras that are held in this way. `cost_of_boxes`: negative log likelihood.
UpHypothesis Held(const NormalisedInput& input, CameraOrientation orientation, double cost_of_boxes,
                  const std::vector<SegmentView>& views) {
  const GroundOptions& options = input.options;
  UpHypothesis hypothesis;
  hypothesis.orientation = orientation;
  hypothesis.verticals = !views.empty();
  const std::vector<Rigid3d> poses = PosesOf(input.sequence);
  const double correlation = options.upright.ViewCorrelation();
  UpPrior up_prior = RobustUpPriorFromCameras(poses, options.tilt, correlation, orientation);
  hypothesis.without_verticals = WithCommonError(up_prior);
  if (!views.empty()) {
    constexpr double kMaxTilt = 12.0 * kRadPerDeg;
    std::vector<SegmentView> in_world = views;
    for (size_t i = 0; i < poses.size(); ++i) in_world[i].world_from_camera = poses[i];
    up_prior = WithVerticals(up_prior, in_world, options.verticals.Sigma(), correlation, kMaxTilt);
  }
  hypothesis.up_prior = WithCommonError(up_prior);
  hypothesis.cost_of_boxes = cost_of_boxes;
  hypothesis.cost = cost_of_boxes + CostOfTurns(input, up_prior.up_in_world);
  return hypothesis;
}

// Cameras that are turned in many ways, but not in all. They only tell that up is within 45 degrees
// of halfway between up in their images and away from what they look at.
std::optional<UpHypothesis> Turned(const NormalisedInput& input, double cost_of_boxes) {
  constexpr double kSigma = 30.0 * kRadPerDeg;
  constexpr double kLeast = 0.5;  // length of the mean: less is of cameras turned in all ways
  Eigen::Vector3d up = Eigen::Vector3d::Zero();  // halfway between level and looking down
  for (const Frame& frame : input.sequence.frames) {
    up -= frame.world_from_camera.rotation * Eigen::Vector3d(0.0, 1.0, 1.0);
  }
  if (up.norm() < kLeast * static_cast<double>(input.sequence.frames.size())) return std::nullopt;
  up.normalize();
  UpHypothesis hypothesis;
  hypothesis.cameras_are_turned = true;
  hypothesis.up_prior = {(Eigen::Matrix3d::Identity() - up * up.transpose()) / (kSigma * kSigma),
                         up};
  hypothesis.without_verticals = hypothesis.up_prior;
  hypothesis.cost_of_boxes = cost_of_boxes;
  return hypothesis;
}

}  // namespace

std::vector<double> UpHypothesis::ObjectsOnPlanes() const {
  std::vector<double> objects_on(planes.planes.size());
  const auto& at_scale = scale_of_objects ? scale_of_objects : scale;
  for (const MeasuredObject& object : objects) {
    const auto& hypotheses = object.evidence.hypotheses;
    const auto shares =
        HypothesisProbabilities(object.evidence, at_scale ? at_scale->log_scale : 0.0);
    for (size_t i = 0; i < shares.size(); ++i) {
      if (hypotheses[i].plane == kNoPlane) continue;
      objects_on[hypotheses[i].plane] += shares[i];
    }
  }
  return objects_on;
}

double UpHypothesis::StandingObjects() const {
  const std::vector<double> on_planes = ObjectsOnPlanes();
  return std::accumulate(on_planes.begin(), on_planes.end(), 0.0);
}

ChosenUp ChooseUp(const NormalisedInput& input, const UpEstimate& of_boxes,
                  const std::vector<SegmentView>& views) {
  constexpr double kClear = 0.1;  // high because level cameras are usual
  const double kWorthFollowing = std::log(1e4);
  std::vector<UpHypothesis> hypotheses;
  for (const CameraOrientation orientation : kCameraOrientations) {
    // Boxes do not tell up from down. A way that they do not tell from another one is not there.
    const CameraOrientation as_by_boxes =
        orientation == CameraOrientation::kRolled180   ? CameraOrientation::kLevel
        : orientation == CameraOrientation::kRolled270 ? CameraOrientation::kRolled90
                                                       : orientation;
    const auto tried =
        std::ranges::find(of_boxes.orientations, as_by_boxes, &TriedOrientation::orientation);
    if (tried == of_boxes.orientations.end()) continue;
    const double prior = as_by_boxes == CameraOrientation::kLevel ? 0.0 : kNotLevelCost;
    hypotheses.push_back(Held(input, orientation, tried->cost - prior, views));
  }
  const auto with_prior = [](const UpHypothesis& hypothesis) {
    return hypothesis.cost +
           (hypothesis.orientation == CameraOrientation::kLevel ? 0.0 : kNotLevelCost);
  };
  double least = std::numeric_limits<double>::infinity();
  for (const UpHypothesis& one : hypotheses) least = std::min(least, with_prior(one));
  std::erase_if(hypotheses,
                [&](const auto& one) { return with_prior(one) > least + kWorthFollowing; });
  // Ways that lead to one up are one: the more probable of them.
  std::vector<UpHypothesis> followed;
  for (UpHypothesis& hypothesis : hypotheses) {
    FindPlanesOfPoints(input, &hypothesis);
    const auto same = std::ranges::find_if(followed, [&](const UpHypothesis& other) {
      return IsSameUp(other.planes.up_in_world, hypothesis.planes.up_in_world);
    });
    if (same == followed.end()) {
      followed.push_back(std::move(hypothesis));
    } else if (with_prior(hypothesis) < with_prior(*same)) {
      *same = std::move(hypothesis);
    }
  }
  for (UpHypothesis& hypothesis : followed) FindObjects(input, &hypothesis);
  const auto choose = [&] {
    std::vector<OrientationEvidence> evidence;
    for (const UpHypothesis& hypothesis : followed) {
      OrientationEvidence& one = evidence.emplace_back();
      one.orientation = hypothesis.orientation;
      one.up_in_world = hypothesis.planes.up_in_world;
      one.other_cost = hypothesis.cost;
    }
    return ChooseOrientation(evidence, 0.0, kClear);
  };
  OrientationChoice choice = choose();
  const UpHypothesis& held = followed[choice.best];
  if (2.0 * held.StandingObjects() < static_cast<double>(held.objects.size())) {
    if (auto turned = Turned(input, held.cost_of_boxes)) {
      FindPlanesOfPoints(input, &*turned);
      FindObjects(input, &*turned);
      followed.push_back(std::move(*turned));
      choice = choose();
    }
  }
  ChosenUp chosen{followed[choice.best], of_boxes};
  const HorizontalPlanes& planes = chosen.hypothesis.planes;
  chosen.of_cameras.orientation = chosen.hypothesis.orientation;
  chosen.of_cameras.orientation_tilt_variance = choice.tilt_variance;
  chosen.of_cameras.orientations.clear();
  double alike = 0.0;  // probability of the ways with that up
  for (size_t i = 0; i < followed.size(); ++i) {
    const double angle = AngleBetween(followed[i].planes.up_in_world, planes.up_in_world);
    alike += kDegPerRad * angle < kTrustedUpDeg ? choice.probabilities[i] : 0.0;
    if (followed[i].cameras_are_turned) continue;  // no way to hold them
    chosen.of_cameras.orientations.push_back(
        {.orientation = followed[i].orientation,
         .verticals = followed[i].verticals,
         .cost = choice.costs[i],
         .probability = choice.probabilities[i],
         .planes = static_cast<int>(followed[i].planes.planes.size())});
  }
  const double trusted = kTrustedUpDeg * kRadPerDeg;
  chosen.probability =
      std::min(1.0, alike) * -std::expm1(-trusted * trusted / planes.tilt_covariance.trace());
  return chosen;
}

}  // namespace soslam

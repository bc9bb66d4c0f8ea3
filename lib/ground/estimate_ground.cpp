// SPDX-License-Identifier: BSD-3-Clause
#include "ground/estimate_ground.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "association/association.h"
#include "base/upper_median.h"
#include "geometry/angles.h"
#include "ground/horizontal_planes.h"
#include "planes/camera_holding.h"
#include "planes/turn_evidence.h"

namespace soslam {

Sequence Transformed(const Similarity& target_from_source, Sequence sequence) {
  for (Frame& frame : sequence.frames) {
    Rigid3d& pose = frame.world_from_camera;
    pose = {(target_from_source.rigid.rotation * pose.rotation).normalized(),
            target_from_source * pose.translation};
  }
  sequence.planes.clear();
  sequence.ground.reset();
  for (Object& object : sequence.objects) object.plane_index = kNoPlane;
  for (Detection& detection : sequence.detections) detection.plane_in_camera = Plane();
  return sequence;
}

std::vector<MapPoint> Transformed(const Similarity& target_from_source,
                                  std::vector<MapPoint> points) {
  for (MapPoint& point : points) {
    point.position_in_world = target_from_source * point.position_in_world;
  }
  return points;
}

namespace {

// Leaves out the boxes of some frames if very many have boxes, but none that edits name.
Sequence WithFewerBoxes(const FoundEdits& edits, Sequence sequence) {
  constexpr size_t kMaxFrames = 200;
  std::vector<int> frames;  // with boxes, ascending
  for (const Detection& detection : sequence.detections) {
    if (frames.empty() || frames.back() != detection.frame_index) {
      frames.push_back(detection.frame_index);
    }
  }
  std::vector<int> kept = SpreadOver(frames, kMaxFrames);
  for (const std::vector<int>& boxes : edits.boxes) {
    for (const int box : boxes) kept.push_back(sequence.detections[box].frame_index);
  }
  std::ranges::sort(kept);
  std::erase_if(sequence.detections, [&](const Detection& detection) {
    return !std::ranges::binary_search(kept, detection.frame_index);
  });
  return sequence;
}

// To the frame of the first camera, in units of the median distance of points from the cameras that
// observe them, or of the path's extent where there are no points.
Similarity NormalisedFromInput(const Sequence& sequence, const std::vector<GroundPoint>& points) {
  std::vector<double> distances;
  for (const GroundPoint& point : points) {
    for (const int index : point.frame_indices) {
      const Frame& frame = sequence.frames[index];
      distances.push_back((frame.world_from_camera.translation - point.position_in_world).norm());
    }
  }
  const Rigid3d& first = sequence.frames.front().world_from_camera;
  if (distances.empty()) {
    for (const Frame& frame : sequence.frames) {
      distances.push_back((frame.world_from_camera.translation - first.translation).norm());
    }
  }
  const double unit = UpperMedian(std::move(distances));
  const double scale = unit > 0.0 ? 1.0 / unit : 1.0;
  const Rigid3d inverse = first.Inverse();
  return {scale, {inverse.rotation, scale * inverse.translation}};
}

// The up prior with an error that all cameras and edges share: edges that are taken for vertical
// need not be.
UpPrior WithCommonError(const UpPrior& up_prior) {
  constexpr double kCommonError = 1.0 * kRadPerDeg;
  const Eigen::Matrix<double, 3, 2> d_turns = UpByTurns(up_prior.up_in_world);
  Eigen::Matrix2d covariance = TiltCovariance(up_prior);
  covariance.diagonal().array() += kCommonError * kCommonError;
  return {d_turns * covariance.inverse() * d_turns.transpose(), up_prior.up_in_world};
}

// What is given, in the normalised world.
struct NormalisedInput {
  const Sequence& sequence;
  const std::vector<GroundPoint>& points;
  const std::vector<TurnedImage>& turned_images;
  const FoundEdits& edits;
  const SemanticTable& table;
  const GroundOptions& options;
  double units_per_input;  // units of the input in a normalised one
  int threads;
};

// A way in which the cameras may be held, and what follows from it in the normalised world.
struct UpHypothesis {
  CameraHolding holding = CameraHolding::kLevel;
  // Negative log likelihoods: of boxes alone, and with turned images and objects on planes.
  double cost_of_boxes = 0.0, cost = 0.0;
  UpPrior up_prior;  // from cameras and vertical edges
  UpPrior without_verticals;
  HorizontalPlanes planes;
  std::vector<MeasuredObject> objects;
  GroundEstimate result;  // what does not need the output's world; its scales are of this one

  // For each plane, the sum of the probabilities of objects to stand on it.
  std::vector<double> ObjectsOnPlanes() const {
    std::vector<double> objects_on(planes.planes.size());
    const auto& at_scale = result.scale_of_objects ? result.scale_of_objects : result.scale;
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
  double StandingObjects() const {
    const std::vector<double> on_planes = ObjectsOnPlanes();
    return std::accumulate(on_planes.begin(), on_planes.end(), 0.0);
  }
};

// Edges that are taken for vertical need not be: those of flat things, seen from above, or any
// where all cameras look in one direction. Where more points lie on planes without them, they are
// ignored; where nearly as many do, up is ambiguous.
void CheckVerticals(const std::vector<GroundPoint>& points, UpHypothesis* hypothesis) {
  constexpr double kSameUp = 3.0 * kRadPerDeg;
  constexpr double kShare = 0.1;  // as many fewer points make a direction e times less probable
  if (!hypothesis->result.verticals) return;
  HorizontalPlanes& planes = hypothesis->planes;
  const UpPrior& without_verticals = hypothesis->without_verticals;
  HorizontalPlanes other = FindHorizontalPlanes(points, without_verticals);
  const double angle = AngleBetween(planes.up_in_world, other.up_in_world);
  if (angle < kSameUp || other.planes.empty()) return;
  const double count = planes.PointCount(), other_count = other.PointCount();
  if (other_count > count) {
    std::swap(planes, other);
    hypothesis->up_prior = without_verticals;
    hypothesis->result.verticals = false;
  }
  const double weight =
      std::exp(-std::abs(count - other_count) / (kShare * std::max(count, other_count)));
  AddAmbiguity(weight / (1.0 + weight) * angle * angle, &planes);
}

// What the settings say of the scale. `on_lowest_plane`: of points, whether or not objects stand on
// it.
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

// The scale by objects and the scales that are known already, to which those of measured objects
// are added.
void TellScale(double same_label_correlation, UpHypothesis* hypothesis) {
  GroundEstimate& result = hypothesis->result;
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
  result.scale_of_objects = EstimateScale(evidence, {});
  std::for_each(measured, objects.end(), add);
  result.scale = EstimateScale(evidence, result.known_scales);
  for (size_t i = 0; i < objects.size(); ++i) {
    objects[i]->evidence.weight = evidence[i].weight;
    objects[i]->pull = result.scale->pull[i];
    if (!objects[i]->size.Any()) continue;
    const auto shares = HypothesisProbabilities(evidence[i], result.scale->log_scale);
    const auto best = std::ranges::max_element(shares) - shares.begin();
    const ScaleHypothesis& taken = evidence[i].hypotheses[best];
    result.known_scales.push_back({taken.log_scale, taken.log_sigma, kSizeByHand});
  }
}

// Finds planes, objects and scale of a hypothesis of which cameras and up priors are known.
void Follow(const NormalisedInput& input, UpHypothesis* hypothesis) {
  HorizontalPlanes& planes = hypothesis->planes;
  GroundEstimate& result = hypothesis->result;
  planes = FindHorizontalPlanes(input.points, hypothesis->up_prior);
  CheckVerticals(input.points, hypothesis);
  result.planes_of_points = static_cast<int>(planes.planes.size());
  std::optional<Eigen::Vector3d> on_lowest_plane;
  if (!planes.planes.empty()) on_lowest_plane = planes.planes.front().centre_in_world;
  const std::vector<BoxGroup> groups =
      WithSizes(input.edits, GroupBoxes(input.sequence, input.points, planes, input.threads));
  const auto measure = [&] {
    UpEstimate up;
    up.up_in_world = planes.up_in_world;
    const Eigen::Matrix3d level = UprightRotation(up.up_in_world, 0.0).toRotationMatrix();
    up.covariance = level.leftCols<2>() * planes.tilt_covariance * level.leftCols<2>().transpose();
    hypothesis->objects = MeasureObjects(input.sequence, groups, input.table, planes, up,
                                         input.options, input.threads);
    result.known_scales = KnownScales(input, planes.up_in_world, on_lowest_plane);
    TellScale(input.options.same_label_correlation, hypothesis);
  };
  measure();
  constexpr double kLeastObjects = 0.5;
  const std::vector<double> objects_on = hypothesis->ObjectsOnPlanes();
  std::vector<PlaneOfPoints> with_objects;
  for (size_t k = 0; k < objects_on.size(); ++k) {
    if (objects_on[k] >= kLeastObjects) with_objects.push_back(planes.planes[k]);
  }
  if (with_objects.size() == planes.planes.size()) return;
  planes.planes = with_objects;
  planes = Refined(planes, input.points, hypothesis->up_prior);
  measure();
}

// Cameras that are held in this way. `cost_of_boxes`: negative log likelihood.
UpHypothesis Held(const NormalisedInput& input, CameraHolding holding, double cost_of_boxes,
                  const std::vector<SegmentView>& views) {
  const GroundOptions& options = input.options;
  UpHypothesis hypothesis;
  hypothesis.holding = holding;
  hypothesis.result.verticals = !views.empty();
  const std::vector<Rigid3d> poses = PosesOf(input.sequence);
  const double correlation = options.upright.ViewCorrelation();
  UpPrior up_prior = RobustUpPriorFromCameras(poses, options.tilt, correlation, holding);
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
  hypothesis.result.cameras_are_turned = true;
  hypothesis.up_prior = {(Eigen::Matrix3d::Identity() - up * up.transpose()) / (kSigma * kSigma),
                         up};
  hypothesis.without_verticals = hypothesis.up_prior;
  hypothesis.cost_of_boxes = cost_of_boxes;
  return hypothesis;
}

// Negative log likelihood ratio of so many objects on support planes: with up as it is, against a
// wrong up. Shares of objects that stand are beta distributed, by 29 synthesised rooms; one scene
// in five is like none of them.
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

// All ways to hold the cameras, compared by one sum: prior, boxes, turned images and objects that
// stand on planes of points. Cameras that are turned in many ways are the last one, where fewer
// than half of the objects stand in the best other one.
UpHypothesis BestHypothesis(const NormalisedInput& input, const UpEstimate& of_boxes,
                            const std::vector<SegmentView>& views) {
  constexpr double kClear = 0.1;  // high because level cameras are usual
  const double kWorthFollowing = std::log(1e4);
  std::vector<UpHypothesis> hypotheses;
  for (const CameraHolding holding : kCameraHoldings) {
    // Boxes do not tell up from down. A way that they do not tell from another one is not there.
    const CameraHolding as_by_boxes = holding == CameraHolding::kRolled180 ? CameraHolding::kLevel
                                      : holding == CameraHolding::kRolled270
                                          ? CameraHolding::kRolled90
                                          : holding;
    const auto tried = std::ranges::find(of_boxes.holdings, as_by_boxes, &TriedHolding::holding);
    if (tried == of_boxes.holdings.end()) continue;
    const double prior = as_by_boxes == CameraHolding::kLevel ? 0.0 : kNotLevelCost;
    hypotheses.push_back(Held(input, holding, tried->cost - prior, views));
  }
  const auto with_prior = [](const UpHypothesis& hypothesis) {
    return hypothesis.cost + (hypothesis.holding == CameraHolding::kLevel ? 0.0 : kNotLevelCost);
  };
  double least = std::numeric_limits<double>::infinity();
  for (const UpHypothesis& one : hypotheses) least = std::min(least, with_prior(one));
  std::erase_if(hypotheses,
                [&](const auto& one) { return with_prior(one) > least + kWorthFollowing; });
  const auto follow = [&](UpHypothesis* hypothesis) {
    Follow(input, hypothesis);
    hypothesis->cost = hypothesis->cost_of_boxes +
                       CostOfTurns(input, hypothesis->planes.up_in_world) +
                       CostOfSupport(hypothesis->StandingObjects(),
                                     static_cast<double>(hypothesis->objects.size()));
    if (hypothesis->result.cameras_are_turned) hypothesis->cost += kNotLevelCost;
  };
  // Ways that lead to one up are one: the more probable of them.
  std::vector<UpHypothesis> followed;
  for (UpHypothesis& hypothesis : hypotheses) {
    follow(&hypothesis);
    const auto same = std::ranges::find_if(followed, [&](const UpHypothesis& other) {
      return IsSameUp(other.planes.up_in_world, hypothesis.planes.up_in_world);
    });
    if (same == followed.end()) {
      followed.push_back(std::move(hypothesis));
    } else if (with_prior(hypothesis) < with_prior(*same)) {
      *same = std::move(hypothesis);
    }
  }
  const auto choose = [&] {
    std::vector<HoldingEvidence> evidence;
    for (const UpHypothesis& hypothesis : followed) {
      HoldingEvidence& one = evidence.emplace_back();
      one.holding = hypothesis.holding;
      one.up_in_world = hypothesis.planes.up_in_world;
      one.other_cost = hypothesis.cost;
    }
    return ChooseHolding(evidence, 0.0, kClear);
  };
  HoldingChoice choice = choose();
  const UpHypothesis& held = followed[choice.best];
  if (2.0 * held.StandingObjects() < static_cast<double>(held.objects.size())) {
    if (auto turned = Turned(input, held.cost_of_boxes)) {
      follow(&*turned);
      followed.push_back(std::move(*turned));
      choice = choose();
    }
  }
  UpHypothesis best = followed[choice.best];
  best.result.up_of_cameras = of_boxes;
  best.result.up_of_cameras.holding = best.holding;
  best.result.up_of_cameras.holding_tilt_variance = choice.tilt_variance;
  double alike = 0.0;  // probability of the ways with that up
  for (size_t i = 0; i < followed.size(); ++i) {
    const double angle = AngleBetween(followed[i].planes.up_in_world, best.planes.up_in_world);
    alike += kDegPerRad * angle < kTrustedUpDeg ? choice.probabilities[i] : 0.0;
  }
  const double trusted = kTrustedUpDeg * kRadPerDeg;
  best.result.up_probability =
      std::min(1.0, alike) * -std::expm1(-trusted * trusted / best.planes.tilt_covariance.trace());
  best.result.up_of_cameras.holdings.clear();
  for (size_t i = 0; i < followed.size(); ++i) {
    if (followed[i].result.cameras_are_turned) continue;  // no way to hold them
    best.result.up_of_cameras.holdings.push_back(
        {.holding = followed[i].holding,
         .verticals = followed[i].result.verticals,
         .cost = choice.costs[i],
         .probability = choice.probabilities[i],
         .planes = static_cast<int>(followed[i].planes.planes.size())});
  }
  return best;
}

void Shift(double log_factor, std::optional<ScalePosterior>* posterior) {
  if (!*posterior) return;
  (*posterior)->log_scale += log_factor;
  (*posterior)->low += log_factor;
  (*posterior)->high += log_factor;
}

GroundObject OutputObject(const Similarity& output_from_normalised, const MeasuredObject& object,
                          double log_units, double log_scale) {
  GroundObject result;
  result.boxes = static_cast<int>(object.detections.size());
  result.label = std::ranges::max_element(object.votes, {}, [](const auto& vote) {
                   return vote.second;
                 })->first;
  result.is_measured = object.size.Any();
  if (object.evidence.hypotheses.empty()) return result;
  const auto shares = HypothesisProbabilities(object.evidence, log_scale);
  const auto best = static_cast<size_t>(std::ranges::max_element(shares) - shares.begin());
  const ScaleHypothesis& hypothesis = object.evidence.hypotheses[best];
  const Landmark& landmark = object.landmarks[best];
  result.label = hypothesis.label;
  result.plane = hypothesis.plane;
  result.centre_in_world = output_from_normalised * landmark.Centre();
  result.height_m = 2.0 * output_from_normalised.scale * landmark.half_axes.z();
  result.log_scale = hypothesis.log_scale - log_units;
  result.log_sigma = hypothesis.log_sigma;
  result.weight = object.evidence.weight;
  result.pull = object.pull;
  for (const double share : shares) result.agreement += share;
  return result;
}

}  // namespace

GroundEstimate EstimateGround(const Sequence& sequence, const std::vector<MapPoint>& points,
                              const std::vector<SegmentView>& views,
                              const std::vector<TurnedImage>& turned_images, const Edits& edits,
                              const SemanticTable& table, const GroundOptions& options,
                              int threads) {
  const Similarity normalised_from_input =
      NormalisedFromInput(sequence, GroundPoints(sequence, points));
  const auto find_boxes = [&](const Sequence& of) {
    std::vector<DetectionDecision> decisions(of.detections.size());
    WithoutDuplicates(of, FitOptions(options).duplicate_overlap, &decisions);
    return FindBoxes(edits, of, decisions);
  };
  const Sequence normalised =
      WithFewerBoxes(find_boxes(sequence), Transformed(normalised_from_input, sequence));
  const FoundEdits found = find_boxes(normalised);
  const auto ground_points = GroundPoints(normalised, Transformed(normalised_from_input, points));
  // The scale is that of the normalised world until the end.
  const double log_units = -std::log(normalised_from_input.scale);
  const NormalisedInput input{normalised, ground_points, turned_images,       found,
                              table,      options,       std::exp(log_units), threads};
  const UpEstimate of_boxes = UpOfSegments(normalised, table, FitOptions(options)).begin()->second;
  const UpHypothesis best = BestHypothesis(input, of_boxes, views);

  GroundEstimate result = best.result;
  // The output's world: z up, metres, its origin below the first camera on the lowest plane. Where
  // the scale is unknown, the unit is that of the input.
  Similarity output;
  output.scale = result.scale ? std::exp(result.scale->log_scale) : input.units_per_input;
  output.rigid.rotation = UprightRotation(best.planes.up_in_world, 0.0).conjugate();
  if (!best.planes.planes.empty()) {
    output.rigid.translation.z() = -output.scale * best.planes.planes.front().height;
  }
  result.output_from_input = output * normalised_from_input;
  result.up_in_input = normalised_from_input.rigid.rotation.conjugate() * best.planes.up_in_world;
  result.tilt_covariance = best.planes.tilt_covariance;
  result.tilt_covariance.diagonal().array() += 0.5 * result.up_of_cameras.holding_tilt_variance;
  result.tilt_sigma = std::sqrt(result.tilt_covariance.trace());
  result.cameras_tilt_sigma = std::sqrt(TiltCovariance(best.up_prior).trace());
  result.tilt_to_cameras = AngleBetween(best.up_prior.up_in_world, best.planes.up_in_world);
  Shift(-log_units, &result.scale);
  Shift(-log_units, &result.scale_of_objects);
  for (KnownScale& known : result.known_scales) known.log_scale -= log_units;
  result.points = static_cast<int>(ground_points.size());
  for (const PlaneOfPoints& plane : best.planes.planes) {
    EstimatedPlane& in_output = result.planes.emplace_back();
    in_output.point_in_world = output * plane.centre_in_world;
    in_output.point_in_world.z() = output.scale * plane.height + output.rigid.translation.z();
    in_output.plane_in_world = {Eigen::Vector3d::UnitZ(), -in_output.point_in_world.z()};
    const Eigen::Vector3d units(1.0, 1.0, output.scale);
    in_output.covariance = units.asDiagonal() * plane.covariance * units.asDiagonal();
    result.points_on_planes.push_back(static_cast<int>(plane.points_in_world.size()));
  }
  for (const MeasuredObject& object : best.objects) {
    result.objects.push_back(OutputObject(output, object, log_units, std::log(output.scale)));
  }
  return result;
}

// The priors of tilt and height leave out their correlation: the height is that in the middle of
// the plane's points, about which a least squares plane turns independently of how it rises. What
// is left, from points of different weights, is below 0.1.
Sequence WithGround(const Sequence& sequence, const GroundEstimate& estimate) {
  Sequence result = Transformed(estimate.output_from_input, sequence);
  constexpr double kClutter = 0.02;  // m: a plane's points are also of what lies on it (a guess)
  result.odometry_world = OdometryWorld::kOwnWithScale;
  const Eigen::Matrix<double, 3, 2> d_turns = UpByTurns(Eigen::Vector3d::UnitZ());
  PointGround& ground = result.ground.emplace();
  ground.up_information = d_turns * estimate.tilt_covariance.inverse() * d_turns.transpose();
  for (const EstimatedPlane& plane : estimate.planes) {
    ground.planes.push_back(
        {plane.point_in_world, std::hypot(kClutter, std::sqrt((*plane.covariance)(2, 2)))});
  }
  return result;
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "ground/estimate_ground.h"

#include <Eigen/Dense>
#include <cmath>
#include <numeric>

#include "base/upper_median.h"
#include "geometry/angles.h"
#include "ground/horizontal_planes.h"

namespace soslam {

Sequence Transformed(const Similarity& target_from_source, Sequence sequence) {
  for (Frame& frame : sequence.frames) {
    Rigid3d& pose = frame.world_from_camera;
    pose = {(target_from_source.rigid.rotation * pose.rotation).normalized(),
            target_from_source * pose.translation};
  }
  sequence.planes.clear();
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

// Leaves out the boxes of some frames if very many have boxes.
Sequence WithFewerBoxes(Sequence sequence) {
  constexpr size_t kMaxFrames = 200;
  std::vector<int> frames;  // with boxes, ascending
  for (const Detection& detection : sequence.detections) {
    if (frames.empty() || frames.back() != detection.frame_index) {
      frames.push_back(detection.frame_index);
    }
  }
  const std::vector<int> kept = SpreadOver(frames, kMaxFrames);
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
  const SemanticTable& table;
  const GroundOptions& options;
  double units_per_input;  // units of the input in a normalised one
  int threads;
};

// A way in which the cameras may be held, and what follows from it in the normalised world.
struct UpHypothesis {
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

// Cameras that all look in one direction do not tell vertical edges from others. Where more points
// lie on planes without them, they are ignored; where nearly as many do, up is ambiguous.
void CheckVerticals(const std::vector<GroundPoint>& points, UpHypothesis* hypothesis) {
  constexpr double kRoughly = 10.0 * kRadPerDeg;
  constexpr double kSameUp = 3.0 * kRadPerDeg;
  constexpr double kShare = 0.1;  // as many fewer points make a direction e times less probable
  HorizontalPlanes& planes = hypothesis->planes;
  const UpPrior& without_verticals = hypothesis->without_verticals;
  if (!hypothesis->result.verticals ||
      std::sqrt(TiltCovariance(without_verticals).trace()) < kRoughly) {
    return;
  }
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

// Finds planes, objects and scale of a hypothesis of which cameras and up priors are known.
void Follow(const NormalisedInput& input, UpHypothesis* hypothesis) {
  HorizontalPlanes& planes = hypothesis->planes;
  GroundEstimate& result = hypothesis->result;
  planes = FindHorizontalPlanes(input.points, hypothesis->up_prior);
  CheckVerticals(input.points, hypothesis);
  result.planes_of_points = static_cast<int>(planes.planes.size());
  std::optional<Eigen::Vector3d> on_lowest_plane;
  if (!planes.planes.empty()) on_lowest_plane = planes.planes.front().centre_in_world;
  const auto groups = GroupBoxes(input.sequence, input.points, planes, input.threads);
  const auto measure = [&] {
    UpEstimate up = result.up_of_cameras;
    up.up_in_world = planes.up_in_world;
    const Eigen::Matrix3d level = UprightRotation(up.up_in_world, 0.0).toRotationMatrix();
    up.covariance = level.leftCols<2>() * planes.tilt_covariance * level.leftCols<2>().transpose();
    hypothesis->objects = MeasureObjects(input.sequence, groups, input.table, planes, up,
                                         input.options, input.threads);
    std::vector<ScaleEvidence> evidence;
    for (const MeasuredObject& object : hypothesis->objects) evidence.push_back(object.evidence);
    WeightSameLabels(input.options.same_label_correlation, &evidence);
    for (size_t i = 0; i < evidence.size(); ++i) {
      hypothesis->objects[i].evidence.weight = evidence[i].weight;
    }
    std::erase_if(evidence, [](const ScaleEvidence& one) { return one.hypotheses.empty(); });
    result.scale_of_objects = EstimateScale(evidence, {});
    result.known_scales = KnownScales(input, planes.up_in_world, on_lowest_plane);
    result.scale = EstimateScale(evidence, result.known_scales);
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

// Cameras that are held in this way.
UpHypothesis FollowHeld(const NormalisedInput& input, const UpEstimate& held,
                        const std::vector<SegmentView>& views) {
  const GroundOptions& options = input.options;
  UpHypothesis hypothesis;
  hypothesis.result.up_of_cameras = held;
  hypothesis.result.verticals = !views.empty();
  const std::vector<Rigid3d> poses = PosesOf(input.sequence);
  const double correlation = options.upright.ViewCorrelation();
  UpPrior up_prior = RobustUpPriorFromCameras(poses, options.tilt, correlation, held.holding);
  hypothesis.without_verticals = WithCommonError(up_prior);
  if (!views.empty()) {
    constexpr double kMaxTilt = 12.0 * kRadPerDeg;
    std::vector<SegmentView> in_world = views;
    for (size_t i = 0; i < poses.size(); ++i) in_world[i].world_from_camera = poses[i];
    up_prior = WithVerticals(up_prior, in_world, options.verticals.Sigma(), correlation, kMaxTilt);
  }
  hypothesis.up_prior = WithCommonError(up_prior);
  Follow(input, &hypothesis);
  return hypothesis;
}

// Cameras that are turned in many ways, but not in all. They only tell that up is within 45 degrees
// of halfway between up in their images and away from what they look at.
std::optional<UpHypothesis> FollowTurned(const NormalisedInput& input,
                                         const UpEstimate& up_of_cameras) {
  constexpr double kSigma = 30.0 * kRadPerDeg;
  constexpr double kLeast = 0.5;  // length of the mean: less is of cameras turned in all ways
  Eigen::Vector3d up = Eigen::Vector3d::Zero();  // halfway between level and looking down
  for (const Frame& frame : input.sequence.frames) {
    up -= frame.world_from_camera.rotation * Eigen::Vector3d(0.0, 1.0, 1.0);
  }
  if (up.norm() < kLeast * static_cast<double>(input.sequence.frames.size())) return std::nullopt;
  up.normalize();
  UpHypothesis hypothesis;
  hypothesis.result.up_of_cameras = up_of_cameras;
  hypothesis.result.cameras_are_turned = true;
  hypothesis.up_prior = {(Eigen::Matrix3d::Identity() - up * up.transpose()) / (kSigma * kSigma),
                         up};
  hypothesis.without_verticals = hypothesis.up_prior;
  Follow(input, &hypothesis);
  return hypothesis;
}

// With the cameras held as their boxes say. Where fewer than half of the objects then stand on
// planes, other ways to hold them are tried, cameras that are turned in many ways last: one in
// which more than twice as many stand, on planes of more than twice as many points, is better.
UpHypothesis BestHypothesis(const NormalisedInput& input, const UpEstimate& of_cameras,
                            const std::vector<SegmentView>& views) {
  constexpr double kMost = 0.5, kClearly = 2.0;
  UpHypothesis best = FollowHeld(input, of_cameras, views);
  const auto most_stand = [&] {
    return best.StandingObjects() >= kMost * static_cast<double>(best.objects.size());
  };
  const auto take_if_better = [&](const UpHypothesis& other) {
    if (other.StandingObjects() > kClearly * best.StandingObjects() &&
        other.planes.PointCount() > kClearly * best.planes.PointCount()) {
      best = other;
    }
  };
  for (const CameraHolding holding : kCameraHoldings) {
    if (most_stand()) return best;
    if (holding == of_cameras.holding) continue;
    UpEstimate held = of_cameras;
    held.holding = holding;
    take_if_better(FollowHeld(input, held, views));
  }
  if (most_stand()) return best;
  if (const auto turned = FollowTurned(input, of_cameras)) take_if_better(*turned);
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
  for (const double share : shares) result.agreement += share;
  return result;
}

}  // namespace

GroundEstimate EstimateGround(const Sequence& sequence, const std::vector<MapPoint>& points,
                              const std::vector<SegmentView>& views, const SemanticTable& table,
                              const GroundOptions& options, int threads) {
  const Similarity normalised_from_input =
      NormalisedFromInput(sequence, GroundPoints(sequence, points));
  const Sequence normalised = WithFewerBoxes(Transformed(normalised_from_input, sequence));
  const auto ground_points = GroundPoints(normalised, Transformed(normalised_from_input, points));
  // The scale is that of the normalised world until the end.
  const double log_units = -std::log(normalised_from_input.scale);
  const NormalisedInput input{normalised, ground_points,       table,
                              options,    std::exp(log_units), threads};
  const UpEstimate of_cameras =
      UpOfSegments(normalised, table, FitOptions(options)).begin()->second;
  const UpHypothesis best = BestHypothesis(input, of_cameras, views);

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
  result.tilt_sigma = std::sqrt(best.planes.tilt_covariance.trace());
  result.cameras_tilt_sigma = std::sqrt(TiltCovariance(best.up_prior).trace());
  result.tilt_to_cameras = AngleBetween(best.up_prior.up_in_world, best.planes.up_in_world);
  Shift(-log_units, &result.scale);
  Shift(-log_units, &result.scale_of_objects);
  for (KnownScale& known : result.known_scales) known.log_scale -= log_units;
  result.holding_of_boxes = of_cameras.holding;
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
  result.odometry_world = OdometryWorld::kOwnWithScale;
  const Eigen::Matrix<double, 3, 2> d_turns = UpByTurns(Eigen::Vector3d::UnitZ());
  for (const EstimatedPlane& plane : estimate.planes) {
    const Eigen::Matrix2d information = plane.covariance->topLeftCorner<2, 2>().inverse();
    result.planes.push_back(
        {.id = static_cast<int>(result.planes.size()),
         .plane_in_world = plane.plane_in_world,
         .attitude_information = d_turns * information * d_turns.transpose(),
         .height_prior = HeightPrior{plane.point_in_world, std::sqrt((*plane.covariance)(2, 2))}});
  }
  return result;
}

}  // namespace soslam

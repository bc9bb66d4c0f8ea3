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

// All steps, in the normalised world.
class Estimation {
 public:
  Estimation(const Sequence& sequence, const std::vector<GroundPoint>& points,
             const SemanticTable& table, const GroundOptions& options, int threads)
      : sequence_(sequence), points_(points), table_(table), options_(options), threads_(threads) {}

  // Runs all steps for cameras that are held in this way.
  void Run(const UpEstimate& held, const std::vector<SegmentView>& views) {
    result.up_of_cameras = held;
    FindUpPrior(views);
    Run();
  }

  // The same for cameras that are turned in many ways. They only tell that up is within 45 degrees
  // of halfway between up in their images and away from what they look at.
  void RunTurned(const UpEstimate& up_of_cameras) {
    constexpr double kSigma = 30.0 * kRadPerDeg;
    constexpr double kLeast = 0.5;  // length of the mean: less is of cameras turned in all ways
    result.up_of_cameras = up_of_cameras;
    result.cameras_are_turned = true;
    Eigen::Vector3d up = Eigen::Vector3d::Zero();  // halfway between level and looking down
    for (const Frame& frame : sequence_.frames) {
      up -= frame.world_from_camera.rotation * Eigen::Vector3d(0.0, 1.0, 1.0);
    }
    if (up.norm() < kLeast * static_cast<double>(sequence_.frames.size())) return;
    up.normalize();
    up_prior = {(Eigen::Matrix3d::Identity() - up * up.transpose()) / (kSigma * kSigma), up};
    without_verticals = up_prior;
    Run();
  }

  // Sum of the probabilities of objects to stand on planes.
  double StandingObjects() const {
    const std::vector<double> on_planes = ObjectsOnPlanes();
    return std::accumulate(on_planes.begin(), on_planes.end(), 0.0);
  }

  double units_per_input = 1.0;  // units of the input in a normalised one
  UpPrior up_prior;              // from cameras and vertical edges
  UpPrior without_verticals;
  HorizontalPlanes planes;
  std::vector<MeasuredObject> objects;
  GroundEstimate result;  // what does not need the output's world; its scales are of this one

 private:
  void Run() {
    planes = FindHorizontalPlanes(points_, up_prior);
    CheckVerticals();
    result.planes_of_points = static_cast<int>(planes.planes.size());
    if (result.planes_of_points > 0) on_lowest_plane_ = planes.planes.front().centre_in_world;
    const auto groups = GroupBoxes(sequence_, points_, planes, threads_);
    Measure(groups);
    if (DropPlanesWithoutObjects()) {
      planes = Refined(planes, points_, up_prior);
      Measure(groups);
    }
  }

  void FindUpPrior(const std::vector<SegmentView>& views) {
    const std::vector<Rigid3d> poses = PosesOf(sequence_);
    const double correlation = options_.upright.ViewCorrelation();
    up_prior =
        RobustUpPriorFromCameras(poses, options_.tilt, correlation, result.up_of_cameras.holding);
    without_verticals = WithCommonError(up_prior);
    result.verticals = !views.empty();
    if (result.verticals) {
      constexpr double kMaxTilt = 12.0 * kRadPerDeg;
      std::vector<SegmentView> in_world = views;
      for (size_t i = 0; i < poses.size(); ++i) in_world[i].world_from_camera = poses[i];
      up_prior =
          WithVerticals(up_prior, in_world, options_.verticals.Sigma(), correlation, kMaxTilt);
    }
    up_prior = WithCommonError(up_prior);
  }

  // Cameras that all look in one direction do not tell vertical edges from others. Where more
  // points lie on planes without them, they are ignored; where nearly as many do, up is ambiguous.
  void CheckVerticals() {
    constexpr double kRoughly = 10.0 * kRadPerDeg;
    constexpr double kSameUp = 3.0 * kRadPerDeg;
    constexpr double kShare = 0.1;  // as many fewer points make a direction e times less probable
    if (!result.verticals || std::sqrt(TiltCovariance(without_verticals).trace()) < kRoughly)
      return;
    HorizontalPlanes other = FindHorizontalPlanes(points_, without_verticals);
    const double angle = AngleBetween(planes.up_in_world, other.up_in_world);
    if (angle < kSameUp || other.planes.empty()) return;
    const double points = planes.PointCount(), other_points = other.PointCount();
    if (other_points > points) {
      std::swap(planes, other);
      up_prior = without_verticals;
      result.verticals = false;
    }
    const double weight =
        std::exp(-std::abs(points - other_points) / (kShare * std::max(points, other_points)));
    AddAmbiguity(weight / (1.0 + weight) * angle * angle, &planes);
  }

  void Measure(const std::vector<std::vector<int>>& groups) {
    UpEstimate up = result.up_of_cameras;
    up.up_in_world = planes.up_in_world;
    const Eigen::Matrix3d level = UprightRotation(up.up_in_world, 0.0).toRotationMatrix();
    up.covariance = level.leftCols<2>() * planes.tilt_covariance * level.leftCols<2>().transpose();
    objects = MeasureObjects(sequence_, groups, table_, planes, up, options_, threads_);
    std::vector<ScaleEvidence> evidence;
    for (const MeasuredObject& object : objects) evidence.push_back(object.evidence);
    WeightSameLabels(options_.same_label_correlation, &evidence);
    for (size_t i = 0; i < objects.size(); ++i) objects[i].evidence.weight = evidence[i].weight;
    std::erase_if(evidence, [](const ScaleEvidence& one) { return one.hypotheses.empty(); });
    result.scale_of_objects = EstimateScale(evidence, {});
    result.known_scales = Known();
    result.scale = EstimateScale(evidence, result.known_scales);
  }

  std::vector<KnownScale> Known() const {
    std::vector<KnownScale> known;
    if (options_.scale > 0.0) {
      known.push_back(
          {std::log(options_.scale * units_per_input), options_.scale_log_sigma, "scale"});
    }
    if (options_.camera_height_m > 0.0 && on_lowest_plane_) {
      std::vector<double> heights;
      for (const Frame& frame : sequence_.frames) {
        heights.push_back(
            planes.up_in_world.dot(frame.world_from_camera.translation - *on_lowest_plane_));
      }
      const double height = UpperMedian(std::move(heights));
      if (height > 0.0) {
        known.push_back({std::log(options_.camera_height_m / height),
                         options_.camera_height_log_sigma, "camera_height_m"});
      }
    }
    return known;
  }

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

  // True if some planes are left out and others stay.
  bool DropPlanesWithoutObjects() {
    constexpr double kLeastObjects = 0.5;
    const std::vector<double> objects_on = ObjectsOnPlanes();
    std::vector<PlaneOfPoints> kept;
    for (size_t k = 0; k < objects_on.size(); ++k) {
      if (objects_on[k] >= kLeastObjects) kept.push_back(planes.planes[k]);
    }
    const bool changes = kept.size() < planes.planes.size();
    planes.planes = kept;
    return changes;
  }

  const Sequence& sequence_;
  const std::vector<GroundPoint>& points_;
  const SemanticTable& table_;
  const GroundOptions& options_;
  int threads_;
  std::optional<Eigen::Vector3d> on_lowest_plane_;  // of points, whether or not objects stand on it
};

// With the cameras held as their boxes say. Where fewer than half of the objects then stand on
// planes, other ways to hold them are tried, cameras that are turned in many ways last: one in
// which more than twice as many stand, on planes of more than twice as many points, is better.
Estimation BestHeld(const Estimation& none, const UpEstimate& of_cameras,
                    const std::vector<SegmentView>& views) {
  constexpr double kMost = 0.5, kClearly = 2.0;
  std::optional<Estimation> best(none);
  const auto most_stand = [&] {
    return best->StandingObjects() >= kMost * static_cast<double>(best->objects.size());
  };
  const auto take_if_better = [&](Estimation other) {
    if (other.StandingObjects() > kClearly * best->StandingObjects() &&
        other.planes.PointCount() > kClearly * best->planes.PointCount()) {
      best.emplace(std::move(other));
    }
  };
  best->Run(of_cameras, views);
  for (const CameraHolding holding : kCameraHoldings) {
    if (most_stand()) break;
    if (holding == of_cameras.holding) continue;
    UpEstimate held = of_cameras;
    held.holding = holding;
    Estimation other = none;
    other.Run(held, views);
    take_if_better(std::move(other));
  }
  if (!most_stand()) {
    Estimation turned = none;
    turned.RunTurned(of_cameras);
    take_if_better(std::move(turned));
  }
  return *std::move(best);
}

void Shift(double log_factor, std::optional<ScalePosterior>* posterior) {
  if (!*posterior) return;
  (*posterior)->log_scale += log_factor;
  (*posterior)->low += log_factor;
  (*posterior)->high += log_factor;
}

// The output's world: z up, metres, its origin below the first camera on the lowest plane.
// Where the scale is unknown, the unit is that of the input.
Similarity OutputFromNormalised(const Estimation& estimation) {
  Similarity output;
  const auto& scale = estimation.result.scale;
  output.scale = scale ? std::exp(scale->log_scale) : estimation.units_per_input;
  output.rigid.rotation = UprightRotation(estimation.planes.up_in_world, 0.0).conjugate();
  if (!estimation.planes.planes.empty()) {
    output.rigid.translation.z() = -output.scale * estimation.planes.planes.front().height;
  }
  return output;
}

EstimatedPlane OutputPlane(const Similarity& output_from_normalised, const PlaneOfPoints& plane) {
  EstimatedPlane result;
  result.point_in_world = output_from_normalised * plane.centre_in_world;
  result.point_in_world.z() =
      output_from_normalised.scale * plane.height + output_from_normalised.rigid.translation.z();
  result.plane_in_world = {Eigen::Vector3d::UnitZ(), -result.point_in_world.z()};
  const Eigen::Vector3d units(1.0, 1.0, output_from_normalised.scale);
  result.covariance = units.asDiagonal() * plane.covariance * units.asDiagonal();
  return result;
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
  Estimation none(normalised, ground_points, table, options, threads);
  none.units_per_input = std::exp(log_units);
  const UpEstimate of_cameras =
      UpOfSegments(normalised, table, FitOptions(options)).begin()->second;
  const Estimation estimation = BestHeld(none, of_cameras, views);

  GroundEstimate result = estimation.result;
  const Similarity output = OutputFromNormalised(estimation);
  result.output_from_input = output * normalised_from_input;
  result.up_in_input =
      normalised_from_input.rigid.rotation.conjugate() * estimation.planes.up_in_world;
  result.tilt_sigma = std::sqrt(estimation.planes.tilt_covariance.trace());
  result.cameras_tilt_sigma = std::sqrt(TiltCovariance(estimation.up_prior).trace());
  result.tilt_to_cameras =
      AngleBetween(estimation.up_prior.up_in_world, estimation.planes.up_in_world);
  Shift(-log_units, &result.scale);
  Shift(-log_units, &result.scale_of_objects);
  for (KnownScale& known : result.known_scales) known.log_scale -= log_units;
  result.holding_of_boxes = of_cameras.holding;
  result.points = static_cast<int>(ground_points.size());
  for (const PlaneOfPoints& plane : estimation.planes.planes) {
    result.planes.push_back(OutputPlane(output, plane));
    result.points_on_planes.push_back(static_cast<int>(plane.points_in_world.size()));
  }
  for (const MeasuredObject& object : estimation.objects) {
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

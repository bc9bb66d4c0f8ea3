// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/ground/estimate_ground.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "soslam/association/association.h"
#include "soslam/base/upper_median.h"
#include "soslam/geometry/angles.h"
#include "soslam/ground/horizontal_planes.h"

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

void Shift(double log_factor, std::optional<ScalePosterior>* posterior) {
  if (!*posterior) return;
  (*posterior)->log_scale += log_factor;
  (*posterior)->low += log_factor;
  (*posterior)->high += log_factor;
}

WorldReport::ObjectRow OutputObject(const Similarity& output_from_normalised,
                                    const MeasuredObject& object, double log_units,
                                    double log_scale) {
  WorldReport::ObjectRow result;
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
  if (hypothesis.plane != kNoPlane) result.plane = hypothesis.plane;
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
                              const std::vector<TurnedImage>& turned_images,
                              const PairEvidence& pairs, const Edits& edits,
                              const SemanticTable& table, const GroundOptions& options,
                              int threads) {
  const Similarity normalised_from_input =
      NormalisedFromInput(sequence, GroundPoints(sequence, points));
  const Sequence normalised = Transformed(normalised_from_input, sequence);
  std::vector<DetectionDecision> decisions(sequence.detections.size());
  WithoutDuplicates(normalised, FitOptions(options).duplicate_overlap, &decisions);
  const FoundEdits found = FindBoxes(edits, normalised, decisions);
  const auto ground_points = GroundPoints(normalised, Transformed(normalised_from_input, points));
  // The scale is that of the normalised world until the end.
  const double log_units = -std::log(normalised_from_input.scale);
  const NormalisedInput input{normalised, ground_points, turned_images,       found,  pairs,
                              table,      options,       std::exp(log_units), threads};
  const UpEstimate of_boxes = UpOfSegments(normalised, table, FitOptions(options)).begin()->second;
  const ChosenUp up = ChooseUp(input, of_boxes, views);
  const UpHypothesis& best = up.hypothesis;

  GroundEstimate result;
  result.up_of_cameras = up.of_cameras;
  result.up_probability = up.probability;
  result.cameras_are_turned = best.cameras_are_turned;
  result.verticals = best.verticals;
  result.scale = best.scale;
  result.known_scales = best.known_scales;
  result.scale_of_objects = best.scale_of_objects;
  result.planes_of_points = best.planes_of_points;
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
  result.tilt_covariance.diagonal().array() += 0.5 * result.up_of_cameras.orientation_tilt_variance;
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
  PointGround& ground = result.ground.emplace();
  ground.up_information =
      WithTiltCovariance(ground.up_in_world, estimate.tilt_covariance).information;
  for (const EstimatedPlane& plane : estimate.planes) {
    ground.planes.push_back(
        {plane.point_in_world, std::hypot(kClutter, std::sqrt((*plane.covariance)(2, 2)))});
  }
  return result;
}

}  // namespace soslam

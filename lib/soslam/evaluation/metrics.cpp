// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/evaluation/metrics.h"

#include "soslam/evaluation/landmark_errors.h"
#include "soslam/evaluation/statistics.h"
#include "soslam/evaluation/trajectory_error.h"

namespace soslam {
namespace {

// Means over an object's observations (or its one landmark of the map): an observation without
// landmark has IoU 0 and no angles.
ObjectMetrics Average(int object_index, int observations,
                      const std::vector<std::optional<LandmarkErrors>>& errors) {
  ObjectMetrics metrics;
  metrics.object_index = object_index;
  metrics.observations = observations;
  std::vector<LandmarkErrors> known;
  for (const auto& error : errors) {
    if (error) known.push_back(*error);
  }
  metrics.estimates = static_cast<int>(known.size());
  const auto iou = [](const auto& error) { return error ? error->iou : 0.0; };
  metrics.iou = MeanOf(CollectValues(errors, iou)).value_or(0.0);
  metrics.what_if = MeanWhatIf(errors, [](const auto& error) {
    return error ? error->what_if : std::optional<WhatIf>(WhatIf());
  });
  metrics.centre_m = MeanOf(CollectValues(known, &LandmarkErrors::centre_m));
  metrics.rotation_deg = MeanOf(CollectValues(known, &LandmarkErrors::rotation_deg));
  metrics.yaw_deg = MeanOf(CollectValues(known, &LandmarkErrors::yaw_deg));
  metrics.attitude_deg = MeanOf(CollectValues(known, &LandmarkErrors::attitude_deg));
  return metrics;
}

MetricsSummary Summarise(std::vector<ObjectMetrics> objects) {
  std::erase_if(objects, [](const ObjectMetrics& object) { return object.observations == 0; });
  MetricsSummary summary;
  summary.objects = static_cast<int>(objects.size());
  for (const ObjectMetrics& object : objects) summary.observations += object.observations;
  const std::vector<double> ious = CollectValues(objects, &ObjectMetrics::iou);
  const std::vector<double> rotations = CollectValues(objects, &ObjectMetrics::rotation_deg);
  const std::vector<double> yaws = CollectValues(objects, &ObjectMetrics::yaw_deg);
  summary.iou_mean = MeanOf(ious);
  summary.iou_median = MedianOf(ious);
  summary.rotation_deg_mean = MeanOf(rotations);
  summary.rotation_deg_median = MedianOf(rotations);
  summary.yaw_error_deg_mean = MeanOf(yaws);
  summary.yaw_error_deg_median = MedianOf(yaws);
  summary.what_if = MeanWhatIf(objects, &ObjectMetrics::what_if);
  std::vector<FrontError> fronts;
  for (const ObjectMetrics& object : objects) fronts.push_back(object.front);
  summary.fronts = SummariseFronts(fronts);
  return summary;
}

std::vector<ObjectMetrics> EvaluateObjects(const Sequence& sequence,
                                           const std::vector<ObjectEstimate>& estimates) {
  const auto detections = DetectionsByObject(sequence);
  std::vector<ObjectMetrics> objects;
  for (size_t i = 0; i < sequence.objects.size(); ++i) {
    const auto& truth = sequence.objects[i].ground_truth;
    if (!truth || !sequence.objects[i].is_static) continue;
    std::vector<std::optional<LandmarkErrors>> errors;
    FrontError front;
    for (const ObjectEstimate& estimate : estimates) {
      if (estimate.object_index == static_cast<int>(i) && estimate.landmark_in_world) {
        errors.push_back(
            CompareLandmarks(*estimate.landmark_in_world, *truth, truth->landmark_in_world));
        front = CompareFronts(estimate, *estimate.landmark_in_world, *truth);
      }
    }
    objects.push_back(Average(static_cast<int>(i), static_cast<int>(detections[i].size()), errors));
    objects.back().front = front;
  }
  return objects;
}

}  // namespace

Metrics EvaluateLandmarks(const Sequence& sequence, const LandmarkEstimates& estimates,
                          AlignmentKind alignment) {
  Metrics metrics;
  if (estimates.observations.empty()) {
    metrics.objects = EvaluateObjects(sequence, estimates.objects);
  } else {
    std::vector<ObjectMetrics> first_only;
    // In frame order; none for an observation without landmark.
    std::vector<std::vector<std::optional<LandmarkErrors>>> errors_by_object(
        sequence.objects.size());
    for (const ObservationEstimate& observation : estimates.observations) {
      const Detection& detection = sequence.detections[observation.detection_index];
      const auto& truth = sequence.ObjectOf(detection).ground_truth;
      if (!truth) continue;
      auto& error = errors_by_object[detection.object_index].emplace_back();
      if (observation.hypotheses.empty()) continue;
      error = CompareInCamera(observation.hypotheses.front().landmark_in_camera, *truth,
                              *TrueLandmarkInCamera(sequence, detection));
    }
    for (size_t i = 0; i < sequence.objects.size(); ++i) {
      if (!sequence.objects[i].ground_truth) continue;
      const int object_index = static_cast<int>(i);
      auto& errors = errors_by_object[i];
      metrics.objects.push_back(Average(object_index, static_cast<int>(errors.size()), errors));
      if (!errors.empty()) errors.resize(1);
      first_only.push_back(Average(object_index, static_cast<int>(errors.size()), errors));
    }
    metrics.first_observation = Summarise(first_only);
  }
  metrics.summary = Summarise(metrics.objects);
  std::vector<Rigid3d> held_out_poses;
  for (const HeldOutFrame& held_out : sequence.held_out) {
    held_out_poses.push_back(held_out.frame.world_from_camera);
  }
  metrics.held_out = EvaluateHeldOut(sequence, estimates.objects, held_out_poses);
  if (estimates.observations.empty()) {
    metrics.map_quality = EvaluateMapQuality(sequence, estimates.objects, PosesOf(sequence),
                                             PlanesOf(sequence), alignment);
  }
  return metrics;
}

Metrics EvaluateMap(const Sequence& sequence, const MapEstimate& map, AlignmentKind alignment) {
  Metrics metrics;
  metrics.objects = EvaluateObjects(sequence, map.objects);
  metrics.summary = Summarise(metrics.objects);
  metrics.held_out =
      EvaluateHeldOut(sequence, map.objects, HeldOutPoses(sequence, map.world_from_camera));
  metrics.map_quality = EvaluateMapQuality(sequence, map.objects, map.world_from_camera,
                                           map.planes_in_world, alignment);

  if (sequence.frames.empty()) return metrics;
  // Each segment has a world of its own, so one alignment is not enough.
  const int segment = sequence.frames.front().segment;
  if (sequence.frames.back().segment != segment) return metrics;
  const auto error =
      AbsoluteTrajectoryError(PosePairs(sequence, map.world_from_camera).at(segment));
  if (error) {
    metrics.trajectory = {
        *error, *AbsoluteTrajectoryError(PosePairs(sequence, PosesOf(sequence)).at(segment))};
  }
  return metrics;
}

}  // namespace soslam

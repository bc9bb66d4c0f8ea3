// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/initial_landmarks.h"

#include <algorithm>
#include <limits>

#include "base/upper_median.h"

namespace soslam {
namespace {

// The median over the object's detections of the distance between box and outline; large where the
// outline does not exist.
double MedianEdgeRms(const Sequence& sequence, const std::vector<int>& detections,
                     const Landmark& landmark_in_world) {
  std::vector<double> distances;
  for (const int index : detections) {
    const Detection& detection = sequence.detections[static_cast<size_t>(index)];
    const Frame& frame = sequence.frames[static_cast<size_t>(detection.frame_index)];
    distances.push_back(OutlineEdgeRms(
        sequence.CameraOf(frame), Transform(frame.world_from_camera.Inverse(), landmark_in_world),
        detection.box));
  }
  return UpperMedian(std::move(distances));
}

}  // namespace

std::vector<std::optional<Landmark>> ChooseInitialLandmarks(const Sequence& sequence,
                                                            const LandmarkEstimates& estimates) {
  const auto detections = DetectionsByObject(sequence);
  std::vector<std::optional<Landmark>> initial_landmarks(sequence.objects.size());
  std::vector<double> distances(sequence.objects.size(), std::numeric_limits<double>::infinity());
  for (const ObservationEstimate& observation : estimates.observations) {
    if (observation.hypotheses.empty()) continue;
    const Detection& detection =
        sequence.detections[static_cast<size_t>(observation.detection_index)];
    if (!sequence.ObjectOf(detection).is_static) continue;
    const auto object_index = static_cast<size_t>(detection.object_index);
    const Frame& frame = sequence.frames[static_cast<size_t>(detection.frame_index)];
    for (const Hypothesis& hypothesis : observation.hypotheses) {
      const Landmark in_world = Transform(frame.world_from_camera, hypothesis.landmark_in_camera);
      const double distance = MedianEdgeRms(sequence, detections[object_index], in_world);
      if (!initial_landmarks[object_index] || distance < distances[object_index]) {
        initial_landmarks[object_index] = in_world;
        distances[object_index] = distance;
      }
    }
  }
  for (const ObjectEstimate& object : estimates.objects) {
    if (object.landmark_in_world) {
      initial_landmarks[static_cast<size_t>(object.object_index)] = object.landmark_in_world;
    }
  }
  for (auto& landmark : initial_landmarks) {
    if (landmark) landmark->shape_exponent = kEllipsoidExponent;
  }
  return initial_landmarks;
}

}  // namespace soslam

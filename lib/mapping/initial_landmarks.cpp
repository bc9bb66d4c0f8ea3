// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/initial_landmarks.h"

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
    const Detection& detection = sequence.detections[index];
    const Frame& frame = sequence.frames[detection.frame_index];
    distances.push_back(OutlineEdgeRms(
        sequence.CameraOf(frame), Transform(frame.world_from_camera.Inverse(), landmark_in_world),
        detection.box));
  }
  return UpperMedian(std::move(distances));
}

}  // namespace

std::vector<std::vector<Landmark>> HypothesesByObject(const Sequence& sequence,
                                                      const LandmarkEstimates& estimates) {
  std::vector<std::vector<Landmark>> hypotheses(sequence.objects.size());
  for (const ObservationEstimate& observation : estimates.observations) {
    const Detection& detection = sequence.detections[observation.detection_index];
    const Rigid3d& world_from_camera = sequence.FrameOf(detection).world_from_camera;
    for (const Hypothesis& hypothesis : observation.hypotheses) {
      hypotheses[detection.object_index].push_back(
          Transform(world_from_camera, hypothesis.landmark_in_camera));
    }
  }
  return hypotheses;
}

std::vector<std::optional<Landmark>> ChooseInitialLandmarks(const Sequence& sequence,
                                                            const LandmarkEstimates& estimates) {
  const auto detections = DetectionsByObject(sequence);
  const auto hypotheses = HypothesesByObject(sequence, estimates);
  std::vector<std::optional<Landmark>> initial_landmarks(sequence.objects.size());
  for (size_t i = 0; i < hypotheses.size(); ++i) {
    if (!sequence.objects[i].is_static) continue;
    double least = std::numeric_limits<double>::infinity();
    for (const Landmark& landmark : hypotheses[i]) {
      const double distance = MedianEdgeRms(sequence, detections[i], landmark);
      if (initial_landmarks[i] && !(distance < least)) continue;
      initial_landmarks[i] = landmark;
      least = distance;
    }
  }
  for (const ObjectEstimate& object : estimates.objects) {
    if (object.landmark_in_world) {
      initial_landmarks[object.object_index] = object.landmark_in_world;
    }
  }
  for (auto& landmark : initial_landmarks) {
    if (landmark) landmark->shape_exponents = kEllipsoidExponent;
  }
  return initial_landmarks;
}

}  // namespace soslam

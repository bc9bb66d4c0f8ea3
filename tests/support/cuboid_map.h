// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>

#include "mapping/back_end.h"
#include "support/drawn_cuboids.h"
#include "support/random.h"
#include "support/scene.h"

namespace soslam {

// From the truth, with priors that say nearly the same.
inline BackEndInput TruthInput(const Sequence& sequence) {
  BackEndInput input{sequence, {}, {}, {}, {}};
  for (const Object& object : sequence.objects) {
    const Landmark& landmark = object.ground_truth->landmark_in_world;
    input.initial_landmarks.push_back(landmark);
    input.priors.push_back(ShapePrior{
        landmark.half_axes.head<2>() / landmark.half_axes.z(), {0.02, 0.02}, kCuboidExponent});
  }
  return input;
}

// Initial landmarks beside those of the truth.
inline void Disturb(BackEndInput* input) {
  for (auto& start : input->initial_landmarks) {
    *start = RotatedAboutZ(*start, RandomUniform(-0.1, 0.1));
    start->frame_from_object.translation += RandomVector(-0.05, 0.05);
    start->half_axes *= RandomUniform(0.9, 1.1);
  }
}

// Images in which each object's visible faces are drawn, for all of its detections.
inline std::map<int, std::shared_ptr<const EdgeImage>> DrawnEdges(const Sequence& sequence) {
  std::map<int, std::shared_ptr<const EdgeImage>> images;
  for (size_t i = 0; i < sequence.detections.size(); ++i) {
    const Detection& detection = sequence.detections[i];
    const cv::Mat image =
        DrawCuboids(sequence.camera, {*TrueLandmarkInCamera(sequence, detection)});
    const EdgeMaps maps = ComputeEdgeMaps(image, EdgesOptions());
    images[static_cast<int>(i)] = std::make_shared<const EdgeImage>(
        EdgeImage{std::make_shared<const FrameEdges>(maps), detection.box, {}});
  }
  return images;
}

// All edges of all boxes off by up to `most_px`.
inline Sequence WithBoxNoise(Sequence sequence, double most_px) {
  for (Detection& detection : sequence.detections) {
    detection.box.x_min += RandomUniform(-most_px, most_px);
    detection.box.y_min += RandomUniform(-most_px, most_px);
    detection.box.x_max += RandomUniform(-most_px, most_px);
    detection.box.y_max += RandomUniform(-most_px, most_px);
  }
  return sequence;
}

inline OptimiseOptions TangencyOptions() {
  OptimiseOptions options;
  options.detection_model = DetectionModel::kTangency;
  options.view_correlation_deg = 0.0;  // exact boxes
  options.axes_weight = 0.0;           // random yaws
  options.covariances = false;
  return options;
}

}  // namespace soslam

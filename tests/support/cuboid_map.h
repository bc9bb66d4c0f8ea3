// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "soslam/geometry/iou.h"
#include "soslam/mapping/back_end.h"
#include "soslam/orientation/image_evidence.h"
#include "support/drawn_cuboids.h"
#include "support/random.h"
#include "support/scene.h"

namespace soslam {

// From the truth, with priors that say nearly the same.
inline BackEndInput TruthInput(const Sequence& sequence, double ratio_log_sigma = 0.02) {
  BackEndInput input{sequence, {}, TrueCuboidPriors(sequence, ratio_log_sigma)};
  for (const Object& object : sequence.objects) {
    input.initial_landmarks.push_back(object.ground_truth->landmark_in_world);
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
inline EvidenceOfImages DrawnEdges(const Sequence& sequence) {
  EvidenceOfImages images;
  for (size_t i = 0; i < sequence.detections.size(); ++i) {
    const Detection& detection = sequence.detections[i];
    const cv::Mat image =
        DrawCuboids(sequence.camera, {*TrueLandmarkInCamera(sequence, detection)});
    const EdgeMaps maps = ComputeEdgeMaps(image, EdgesOptions());
    images.emplace_back(
        static_cast<int>(i),
        MakeEdgeEvidence(std::make_shared<const EdgeImage>(EdgeImage{
                             std::make_shared<const FrameEdges>(maps), detection.box, {}}),
                         sequence.camera, EdgeOptions()));
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

// A rigid motion of the whole world leaves the cost unchanged and moves the result: expects the
// same final cost within `final_cost_share`, and moved landmarks with an IoU above `min_iou`.
inline void ExpectThatTheMapMovesWithTheWorld(const BackEndInput& input,
                                              const OptimiseOptions& options,
                                              double final_cost_share, double min_iou) {
  const MapEstimate before = OptimiseMap(input, options);
  const Rigid3d motion = RandomRigid();
  const Sequence moved = TransformSequence(motion, input.sequence);
  BackEndInput moved_input{moved, input.initial_landmarks, input.priors, input.images};
  for (auto& start : moved_input.initial_landmarks) *start = Transform(motion, *start);
  const MapEstimate after = OptimiseMap(moved_input, options);

  EXPECT_NEAR(after.solver.initial_cost, before.solver.initial_cost,
              1e-9 * before.solver.initial_cost);
  EXPECT_NEAR(after.solver.final_cost, before.solver.final_cost,
              final_cost_share * before.solver.final_cost);
  EXPECT_EQ(after.solver.residuals, before.solver.residuals);
  for (size_t i = 0; i < before.objects.size(); ++i) {
    const Landmark expected = Transform(motion, *before.objects[i].landmark_in_world);
    EXPECT_GT(BoxIou(*after.objects[i].landmark_in_world, expected), min_iou) << i;
  }
}

inline OptimiseOptions TangencyOptions() {
  OptimiseOptions options;
  options.detection_model = DetectionModel::kTangency;
  options.upright.view_correlation_deg = 0.0;  // exact boxes
  options.upright.axes_weight = 0.0;           // random yaws
  options.covariances = false;
  return options;
}

}  // namespace soslam

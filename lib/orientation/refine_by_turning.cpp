// SPDX-License-Identifier: BSD-3-Clause
#include "orientation/refine_by_turning.h"

#include <memory>
#include <utility>

#include "geometry/angles.h"
#include "geometry/landmark.h"
#include "initialisation/single_frame.h"
#include "orientation/symmetry_samples.h"
#include "orientation/yaw_profile.h"

namespace soslam {
namespace {

// One observation, and the data that all steps of its refinement share.
struct Refinement {
  const Sequence& sequence;
  const Detection& detection;
  const RefineOptions& options;
  SingleFrameObservation observation;
  std::shared_ptr<const SymmetryImage> image;
  Landmark start;  // in the camera frame
  std::vector<Eigen::Vector2d> samples;
  std::optional<BestTurn> best_turn;
};

double YawInCamera(const Refinement& refinement, const Landmark& landmark) {
  return Yaw(refinement.detection.plane_in_camera.normal, landmark.frame_from_object.rotation);
}

void RecordCurves(const Refinement& refinement, SymmetryRecord* record) {
  const RefineOptions& options = refinement.options;
  const double initial_yaw = YawInCamera(refinement, refinement.start);
  std::vector<Descriptor> descriptors;
  for (size_t i = 0; i < kDescriptorNames.size(); ++i) {
    descriptors.push_back(static_cast<Descriptor>(i));
  }
  const YawProfile profile = ComputeYawProfile(*refinement.image, refinement.observation.camera,
                                               refinement.start, refinement.samples, descriptors,
                                               options.symmetry, options.yaw_step_deg * kRadPerDeg);
  for (size_t i = 0; i < kDescriptorNames.size(); ++i) {
    record->cost[kDescriptorNames[i]] = profile.costs[i];
  }
  for (const double turn : profile.turns) record->yaw.push_back(initial_yaw + turn);
}

void RecordPairs(const Refinement& refinement, const Landmark& landmark, SymmetryRecord* record) {
  const SymmetryOptions& options = refinement.options.symmetry;
  const SymmetryDescriptor evaluate(options.descriptor, *refinement.image,
                                    refinement.observation.camera, landmark);
  for (const Eigen::Vector2d& pixel : refinement.samples) {
    if (const auto pair = evaluate.Evaluate(pixel, options.min_viewing_cosine, false)) {
      record->samples.push_back(pixel.cast<float>());
      record->mirrored.push_back(pair->mirror_pixel.cast<float>());
    }
  }
}

// The hypothesis with the most symmetric texture near its yaw, among those that fit the box as well
// as the first.
Refinement ChooseHypothesis(const Sequence& sequence, const Detection& detection,
                            const std::vector<Hypothesis>& hypotheses, const EdgeMaps& maps,
                            const Eigen::Vector2d& ratio, const RefineOptions& options) {
  const auto image = std::make_shared<const SymmetryImage>(maps, detection.box);
  const Camera& camera = sequence.CameraOf(detection);
  const auto edge_rms = [&](const Hypothesis& hypothesis) {
    return OutlineEdgeRms(camera, hypothesis.landmark_in_camera, detection.box);
  };
  const double tied_rms = edge_rms(hypotheses.front()) + options.tie_edge_px;
  std::optional<Refinement> chosen;
  for (const Hypothesis& hypothesis : hypotheses) {
    if (chosen && !(edge_rms(hypothesis) <= tied_rms)) continue;
    const Landmark& start = hypothesis.landmark_in_camera;
    Refinement refinement{sequence,
                          detection,
                          options,
                          {camera, detection.box, detection.plane_in_camera, ratio},
                          image,
                          start,
                          SamplePixels(*image, camera, start, options.symmetry),
                          std::nullopt};
    refinement.best_turn =
        FindBestTurn(*image, camera, start, refinement.samples, options.symmetry,
                     options.yaw_range_deg * kRadPerDeg, options.yaw_step_deg * kRadPerDeg,
                     options.yaw_resolution_deg * kRadPerDeg);
    if (!chosen || (refinement.best_turn &&
                    (!chosen->best_turn || refinement.best_turn->cost < chosen->best_turn->cost))) {
      chosen.emplace(std::move(refinement));
    }
  }
  return *chosen;
}

// Why a landmark is not refined; empty where it is.
std::string FailureOf(const Refinement& refinement) {
  if (refinement.image->edge_pixels.empty()) return "no_edges";
  return refinement.best_turn ? "" : "too_few_visible_pairs";
}

}  // namespace

std::optional<double> TrueYaw(const Sequence& sequence, const Detection& detection) {
  const auto truth = TrueLandmarkInCamera(sequence, detection);
  if (!truth) return std::nullopt;
  return Yaw(detection.plane_in_camera.normal, truth->frame_from_object.rotation);
}

RefinedObservation RefineByTurning(const Sequence& sequence, const ObservationEstimate& initial,
                                   const EdgeMaps& maps,
                                   const std::optional<Eigen::Vector2d>& ratio,
                                   const RefineOptions& options) {
  const Detection& detection = sequence.detections[initial.detection_index];
  RefinedObservation result;
  result.estimate = initial;
  result.record.frame_id = sequence.frames[detection.frame_index].id;
  result.record.object_id = sequence.objects[detection.object_index].id;
  if (initial.hypotheses.empty()) return result;
  if (!ratio) {
    result.estimate.failure = "no_ratio_for_label";
    return result;
  }

  const Refinement refinement =
      ChooseHypothesis(sequence, detection, initial.hypotheses, maps, *ratio, options);
  Landmark refined = refinement.start;
  result.estimate.failure = FailureOf(refinement);
  if (result.estimate.failure.empty()) {
    refined = RotatedAboutZ(refinement.start, refinement.best_turn->turn);
    result.estimate.hypotheses = {
        {refined, SingleFrameCost(refinement.observation, options.variances, refined)}};
  }
  RecordCurves(refinement, &result.record);
  RecordPairs(refinement, refined, &result.record);
  result.record.initial_yaw = YawInCamera(refinement, refinement.start);
  result.record.refined_yaw = YawInCamera(refinement, refined);
  result.record.true_yaw = TrueYaw(sequence, detection);
  return result;
}

}  // namespace soslam

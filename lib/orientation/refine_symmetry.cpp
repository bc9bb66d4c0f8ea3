// SPDX-License-Identifier: BSD-3-Clause
#include "orientation/refine_symmetry.h"

#include <ceres/ceres.h>

#include <memory>
#include <vector>

#include "geometry/angles.h"
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

// Minimises eq. (12) plus eq. (16) over all nine parameters. Pairs are chosen at the start. None
// when the solver fails.
std::optional<Landmark> SolveAll(const Refinement& refinement, const Landmark& start) {
  const RefineOptions& options = refinement.options;
  const Camera& camera = refinement.observation.camera;
  LandmarkBlock landmark = ToParameterBlock(start);
  PoseBlock camera_pose = ToParameterBlock(Rigid3d());
  ceres::Problem problem;
  AddSingleFrameConstraints(refinement.observation, options.variances, &camera_pose, &landmark,
                            &problem);
  const SymmetryDescriptor at_start(options.symmetry.descriptor, *refinement.image, camera, start);
  for (const Eigen::Vector2d& pixel : refinement.samples) {
    if (!at_start.Evaluate(pixel, options.symmetry.min_viewing_cosine, false)) continue;
    problem.AddResidualBlock(
        new SymmetryResidual(options.symmetry.descriptor, refinement.image, camera, pixel,
                             start.shape_exponent, options.symmetry_sigma),
        new ceres::HuberLoss(1.0), camera_pose.data(), landmark.data());
  }

  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.max_num_iterations = options.max_iterations;
  solver.num_threads = 1;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  if (!summary.IsSolutionUsable()) return std::nullopt;
  return UnpackLandmark(landmark.data());
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

// Writes the refined landmark; otherwise returns the reason of the failure.
std::string Refine(const Refinement& refinement, Landmark* refined) {
  if (refinement.image->edge_pixels.empty()) return "no_edges";
  if (!refinement.best_turn) return "too_few_visible_pairs";
  *refined = RotatedAboutZ(refinement.start, refinement.best_turn->turn);
  if (refinement.options.parameters == RefinementParameters::kYaw) return "";
  const auto solved = SolveAll(refinement, *refined);
  if (!solved) return "solver_failed";
  *refined = *solved;
  return "";
}

}  // namespace

std::optional<double> TrueYaw(const Sequence& sequence, const Detection& detection) {
  const auto truth = TrueLandmarkInCamera(sequence, detection);
  if (!truth) return std::nullopt;
  return Yaw(detection.plane_in_camera.normal, truth->frame_from_object.rotation);
}

RefinedObservation RefineObservation(const Sequence& sequence, const ObservationEstimate& initial,
                                     const EdgeMaps& maps,
                                     const std::optional<Eigen::Vector2d>& ratio,
                                     const RefineOptions& options) {
  const Detection& detection = sequence.detections[static_cast<size_t>(initial.detection_index)];
  RefinedObservation result;
  result.estimate = initial;
  result.record.frame_id = sequence.frames[static_cast<size_t>(detection.frame_index)].id;
  result.record.object_id = sequence.objects[static_cast<size_t>(detection.object_index)].id;
  if (initial.hypotheses.empty()) return result;
  if (!ratio) {
    result.estimate.failure = "no_ratio_for_label";
    return result;
  }

  const Refinement refinement =
      ChooseHypothesis(sequence, detection, initial.hypotheses, maps, *ratio, options);
  Landmark refined = refinement.start;
  result.estimate.failure = Refine(refinement, &refined);
  if (result.estimate.failure.empty()) {
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

// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/back_end_problem.h"

#include <numbers>

#include "base/error.h"
#include "constraints/attitude.h"
#include "constraints/bias.h"
#include "constraints/detection.h"
#include "constraints/manifolds.h"
#include "constraints/odometry.h"
#include "constraints/scale_ratio.h"
#include "constraints/standing.h"
#include "constraints/support.h"
#include "constraints/tangency.h"
#include "initialisation/landmark_term_residual.h"
#include "initialisation/view_weights.h"
#include "mapping/iteration_progress.h"
#include "orientation/texture_asymmetry.h"
#include "symmetry/sampling.h"

namespace soslam {
namespace {

// Reasons for leaving something out.
constexpr const char* kTooFewPairs = "symmetry_with_too_few_visible_pairs";
constexpr const char* kNoEdgeCounts = "no_edge_point_counts";

// Residual blocks share one loss, which outlives the problem.
ceres::Problem::Options BorrowLoss() {
  ceres::Problem::Options options;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  return options;
}

ceres::Solver::Options SolverOptions(int max_iterations) {
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::SPARSE_SCHUR;
  // Last digits of CHOLMOD depend on the BLAS that is installed and on where matrices lie in
  // memory.
  solver.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  solver.max_num_iterations = max_iterations;
  // In the paper's units a pixel is a residual of 1e-3 or less: the default tolerances would stop
  // far from the optimum.
  solver.function_tolerance = 1e-8;
  solver.gradient_tolerance = 1e-14;
  solver.parameter_tolerance = 1e-10;
  solver.num_threads = 1;  // for identical bytes from run to run
  solver.logging_type = ceres::SILENT;
  return solver;
}

}  // namespace

BackEndProblem::BackEndProblem(const BackEndInput& input, const OptimiseOptions& options)
    : input_(input),
      options_(options),
      loss_(options.huber_delta),
      problem_(BorrowLoss()),
      variables_(input) {
  for (size_t i = 0; i < input.sequence.frames.size(); ++i) {
    problem_.AddParameterBlock(variables_.Pose(i), kPoseSize, NewPoseManifold());
  }
  HoldPoses();
  WeighViews();
  if (!options.hold_poses) AddOdometry();
  for (size_t i = 0; i < input.starts.size(); ++i) {
    if (input.starts[i]) AddLandmark(i);
  }
  AddDetections();
}

Landmark BackEndProblem::LandmarkInCamera(const Detection& detection) const {
  return Transform(variables_.PoseValue(static_cast<size_t>(detection.frame_index)).Inverse(),
                   *variables_.LandmarkValue(static_cast<size_t>(detection.object_index)));
}

void BackEndProblem::WeighViews() {
  view_weights_.assign(input_.sequence.detections.size(), 1.0);
  const auto detections = DetectionsByObject(input_.sequence);
  for (size_t i = 0; i < detections.size(); ++i) {
    if (!input_.starts[i]) continue;
    const auto weights = ViewWeights(input_.sequence, detections[i], input_.starts[i]->Centre(),
                                     options_.view_correlation_deg * std::numbers::pi / 180.0);
    for (size_t k = 0; k < weights.size(); ++k) {
      view_weights_[static_cast<size_t>(detections[i][k])] = weights[k];
    }
  }
}

// The first pose of each segment defines its world.
void BackEndProblem::HoldPoses() {
  const auto& frames = input_.sequence.frames;
  for (size_t i = 0; i < frames.size(); ++i) {
    if (options_.hold_poses || i == 0 || frames[i].segment != frames[i - 1].segment) {
      problem_.SetParameterBlockConstant(variables_.Pose(i));
    }
  }
}

void BackEndProblem::AddOdometry() {
  const auto& frames = input_.sequence.frames;
  for (size_t i = 1; i < frames.size(); ++i) {
    if (frames[i].segment != frames[i - 1].segment) continue;
    const Rigid3d first_from_second =
        frames[i - 1].world_from_camera.Inverse() * frames[i].world_from_camera;
    problem_.AddResidualBlock(
        new OdometryResidual(first_from_second,
                             options_.odometry_rotation_sigma_deg * std::numbers::pi / 180.0,
                             options_.odometry_translation_sigma_m),
        &loss_, variables_.Pose(i - 1), variables_.Pose(i));
    ++summary_.residuals["odometry"];
  }
}

// An estimated plane moves with what stands on it, under what is known of its normal besides.
void BackEndProblem::AddStanding(size_t object_index) {
  const auto plane_index = static_cast<size_t>(input_.sequence.objects[object_index].plane_index);
  double* normal = variables_.Normal(plane_index);
  double* offset = variables_.Offset(plane_index);
  const bool is_new_normal = !problem_.HasParameterBlock(normal);
  // No loss: a body that floats is not an outlier, but wrong.
  problem_.AddResidualBlock(
      new StandingResidual(options_.standing_angle_sigma_deg * std::numbers::pi / 180.0,
                           options_.standing_height_sigma_m, variables_.NormalSide(plane_index)),
      nullptr, variables_.Landmark(object_index), normal, offset);
  const auto& attitude = input_.sequence.planes[plane_index].attitude_information;
  if (!attitude || !options_.refine_planes) {
    problem_.SetParameterBlockConstant(normal);
    problem_.SetParameterBlockConstant(offset);
  } else if (is_new_normal) {
    problem_.SetManifold(normal, NewNormalManifold());
    problem_.AddResidualBlock(new AttitudeResidual(*attitude), nullptr, normal);
  }
}

void BackEndProblem::AddLandmark(size_t object_index) {
  const Object& object = input_.sequence.objects[object_index];
  const Plane& plane =
      input_.sequence.planes[static_cast<size_t>(object.plane_index)].plane_in_world;
  double* landmark = variables_.Landmark(object_index);
  problem_.AddParameterBlock(landmark, kLandmarkSize, NewLandmarkManifold());
  if (options_.support) {
    if (options_.detection_model == DetectionModel::kTangency) {
      AddStanding(object_index);
    } else {
      problem_.AddResidualBlock(new SupportResidual(plane, options_.variances.SupportAngleRad2(),
                                                    options_.variances.SupportTangencyM4()),
                                &loss_, landmark);
    }
    ++summary_.residuals["support"];
  }
  if (options_.ratio) AddRatio(object_index);
  if (options_.detection_model == DetectionModel::kTangency && options_.axes_weight > 0.0) {
    problem_.AddResidualBlock(new LandmarkTermResidual(std::make_unique<AxisTerm>(
                                  plane, WorldAxis(plane), options_.axes_weight)),
                              nullptr, landmark);
  }
}

void BackEndProblem::AddRatio(size_t object_index) {
  const auto& prior = input_.priors[object_index];
  if (!prior) {
    ++summary_.gated["object_without_ratio"];
    return;
  }
  double* landmark = variables_.Landmark(object_index);
  if (options_.detection_model == DetectionModel::kTangency) {
    // No loss: a ratio far from the prior is as unlikely as its spread says.
    problem_.AddResidualBlock(new LandmarkTermResidual(std::make_unique<RatioTerm>(*prior)),
                              nullptr, landmark);
  } else {
    problem_.AddResidualBlock(new ScaleRatioResidual(prior->ratio, options_.variances.ratio),
                              &loss_, landmark);
  }
  ++summary_.residuals["ratio"];
}

void BackEndProblem::AddDetections() {
  for (size_t i = 0; i < input_.sequence.detections.size(); ++i) {
    const Detection& detection = input_.sequence.detections[i];
    if (!input_.starts[static_cast<size_t>(detection.object_index)]) {
      ++summary_.gated[input_.sequence.ObjectOf(detection).is_static
                           ? "detection_of_object_without_start"
                           : "detection_of_moving_object"];
      continue;
    }
    const Landmark landmark_in_camera = LandmarkInCamera(detection);
    if (!(landmark_in_camera.Centre().z() > 0.0)) {
      ++summary_.gated["landmark_behind_camera"];
      continue;
    }
    AddDetection(i, landmark_in_camera);
    ++summary_.residuals["detection"];
  }
  if (options_.detection_model == DetectionModel::kTangency) HoldBias();
}

void BackEndProblem::AddDetection(size_t index, const Landmark& landmark_in_camera) {
  const Detection& detection = input_.sequence.detections[index];
  const Camera& camera = input_.sequence.CameraOf(detection);
  double* pose = Pose(detection);
  double* landmark = LandmarkOf(detection);
  if (options_.detection_model == DetectionModel::kQuadric) {
    problem_.AddResidualBlock(
        new DetectionResidual(camera, detection.box, options_.variances.DetectionM4()), &loss_,
        pose, landmark);
    return;
  }
  view_losses_.emplace_back(&loss_, view_weights_[index], ceres::DO_NOT_TAKE_OWNERSHIP);
  const auto edges =
      BoxEdges(camera, detection.box, detection.is_bound, options_.detection_sigma_fraction);
  for (size_t i = 0; i < edges.size(); ++i) {
    // A body so near that it reaches behind the camera has no tangent point in view.
    if (!(TangentDepth(edges[i], landmark_in_camera) > 0.0)) {
      ++summary_.gated["edge_behind_camera"];
      continue;
    }
    problem_.AddResidualBlock(new TangencyResidual(edges[i], landmark_in_camera),
                              &view_losses_.back(), pose, landmark, variables_.Bias(i));
  }
}

void BackEndProblem::HoldBias() {
  for (size_t i = 0; i < variables_.BiasValues().size(); ++i) {
    double* bias = variables_.Bias(i);
    if (!problem_.HasParameterBlock(bias)) continue;
    if (options_.detector_bias_sigma_px > 0.0) {
      problem_.AddResidualBlock(new BiasResidual(options_.detector_bias_sigma_px), nullptr, bias);
    } else {
      problem_.SetParameterBlockConstant(bias);
    }
  }
}

void BackEndProblem::RenewImageTerms() {
  for (const ceres::ResidualBlockId id : image_terms_) problem_.RemoveResidualBlock(id);
  image_terms_.clear();
  for (const char* kind : {"symmetry", "edges"}) summary_.residuals.erase(kind);
  for (const char* reason : {kTooFewPairs, kNoEdgeCounts}) summary_.gated.erase(reason);
  const auto has_start = [&](int detection_index) {
    const Detection& detection = input_.sequence.detections[static_cast<size_t>(detection_index)];
    return input_.starts[static_cast<size_t>(detection.object_index)].has_value();
  };
  for (const auto& [index, image] : input_.symmetry_images) {
    if (has_start(index)) AddSymmetry(static_cast<size_t>(index), image);
  }
  for (const auto& [index, image] : input_.edge_images) {
    if (has_start(index)) AddEdges(static_cast<size_t>(index), image);
  }
}

void BackEndProblem::AddSymmetry(size_t index, const std::shared_ptr<const SymmetryImage>& image) {
  const Landmark in_camera = LandmarkInCamera(input_.sequence.detections[index]);
  if (options_.detection_model == DetectionModel::kTangency) {
    AddAsymmetry(index, image, in_camera);
  } else {
    AddPairs(index, image, in_camera);
  }
}

void BackEndProblem::AddAsymmetry(size_t index, const std::shared_ptr<const SymmetryImage>& image,
                                  const Landmark& landmark_in_camera) {
  const Detection& detection = input_.sequence.detections[index];
  auto residual = std::make_unique<AsymmetryResidual>(
      image, input_.sequence.CameraOf(detection), landmark_in_camera, options_.texture,
      options_.symmetry_options, view_weights_[index]);
  if (residual->num_residuals() == 0) {
    ++summary_.gated[kTooFewPairs];
    return;
  }
  summary_.residuals["symmetry"] += residual->num_residuals();
  // No further loss: a pair's residual is bounded.
  image_terms_.push_back(problem_.AddResidualBlock(residual.release(), nullptr, Pose(detection),
                                                   LandmarkOf(detection)));
}

void BackEndProblem::AddPairs(size_t index, const std::shared_ptr<const SymmetryImage>& image,
                              const Landmark& landmark_in_camera) {
  const Detection& detection = input_.sequence.detections[index];
  const Camera& camera = input_.sequence.CameraOf(detection);
  const SymmetryOptions& symmetry = options_.symmetry_options;
  const SymmetryDescriptor at_start(symmetry.descriptor, *image, camera, landmark_in_camera);
  std::vector<Eigen::Vector2d> visible;
  for (const Eigen::Vector2d& pixel : SamplePixels(*image, camera, landmark_in_camera, symmetry)) {
    if (at_start.Evaluate(pixel, symmetry.min_viewing_cosine, false)) visible.push_back(pixel);
  }
  if (visible.size() < static_cast<size_t>(symmetry.min_pairs)) {
    ++summary_.gated[kTooFewPairs];
    return;
  }
  for (const Eigen::Vector2d& pixel : visible) {
    image_terms_.push_back(problem_.AddResidualBlock(
        new SymmetryResidual(symmetry.descriptor, image, camera, pixel,
                             landmark_in_camera.shape_exponent, options_.symmetry_sigma),
        &loss_, Pose(detection), LandmarkOf(detection)));
  }
  summary_.residuals["symmetry"] += static_cast<int>(visible.size());
}

void BackEndProblem::AddEdges(size_t index, const std::shared_ptr<const EdgeImage>& image) {
  const Detection& detection = input_.sequence.detections[index];
  auto residual = std::make_unique<EdgeAlignmentResidual>(
      image, input_.sequence.CameraOf(detection), LandmarkInCamera(detection), options_.edges,
      view_weights_[index]);
  if (residual->num_residuals() == 0) {
    ++summary_.gated[kNoEdgeCounts];
    return;
  }
  ++summary_.residuals["edges"];
  // No further loss: a point's residual is bounded.
  image_terms_.push_back(problem_.AddResidualBlock(residual.release(), nullptr, Pose(detection),
                                                   LandmarkOf(detection)));
}

std::shared_ptr<ceres::ParameterBlockOrdering> BackEndProblem::LandmarkOrdering() {
  auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  for (size_t i = 0; i < input_.starts.size(); ++i) {
    if (input_.starts[i]) ordering->AddElementToGroup(variables_.Landmark(i), 0);
  }
  return ordering;
}

// Landmarks are eliminated first.
std::shared_ptr<ceres::ParameterBlockOrdering> BackEndProblem::Ordering() {
  auto ordering = LandmarkOrdering();
  const auto add = [&](double* block, int group) {
    if (problem_.HasParameterBlock(block)) ordering->AddElementToGroup(block, group);
  };
  for (size_t i = 0; i < input_.sequence.frames.size(); ++i) add(variables_.Pose(i), 1);
  for (size_t i = 0; i < variables_.BiasValues().size(); ++i) add(variables_.Bias(i), 2);
  for (size_t i = 0; i < input_.sequence.planes.size(); ++i) {
    add(variables_.Normal(i), 3);
    add(variables_.Offset(i), 3);
  }
  return ordering;
}

void BackEndProblem::Solve() {
  ceres::Solver::Options solver = SolverOptions(options_.max_iterations);
  solver.linear_solver_ordering = Ordering();
  // A landmark that its boxes hardly determine would shrink the one trust region of them all: after
  // every step each is optimised for itself.
  solver.use_inner_iterations = true;
  solver.inner_iteration_ordering = LandmarkOrdering();

  IterationProgress progress;
  solver.callbacks.push_back(&progress);

  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem_, &summary);
  if (!summary.IsSolutionUsable()) throw NumericalError("back end: " + summary.message);
  if (summary_.cost_per_iteration.empty()) summary_.initial_cost = summary.initial_cost;
  summary_.final_cost = summary.final_cost;
  summary_.iterations += static_cast<int>(summary.iterations.size()) - 1;
  summary_.converged = summary.termination_type == ceres::CONVERGENCE;
  summary_.detector_bias_px = variables_.BiasValues();
  for (const auto& iteration : summary.iterations) {
    // A rejected step's cost is that of where it would have led.
    const bool stays = iteration.iteration > 0 && !iteration.step_is_successful;
    summary_.cost_per_iteration.push_back(stays ? summary_.cost_per_iteration.back()
                                                : iteration.cost);
  }
}

}  // namespace soslam

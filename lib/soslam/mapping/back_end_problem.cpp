// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/mapping/back_end_problem.h"

#include <ceres/normal_prior.h>

#include <algorithm>

#include "soslam/base/error.h"
#include "soslam/base/progress.h"
#include "soslam/constraints/odometry.h"
#include "soslam/constraints/parameters.h"
#include "soslam/constraints/quadric_constraints.h"
#include "soslam/constraints/standing_on_plane.h"
#include "soslam/constraints/tangency.h"
#include "soslam/geometry/angles.h"
#include "soslam/initialisation/object_evidence.h"
#include "soslam/mapping/linear_solver.h"
#include "soslam/mapping/normal_equations.h"

namespace soslam {
namespace {

ceres::Solver::Options SolverOptions(int max_iterations) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  // CHOLMOD's last digits depend on the BLAS that is installed, sums over several threads on which
  // one ends first.
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  options.num_threads = 1;
  options.max_num_iterations = max_iterations;
  // In the paper's units a pixel is a residual of 1e-3 or less: the default tolerances would stop
  // far from the optimum. With a lower one than this, steps of landmarks at a kink, where an edge
  // of a box meets the corner of a cuboid, succeed or fail by their last digits.
  options.function_tolerance = 1e-7;
  options.gradient_tolerance = 1e-14;
  options.parameter_tolerance = 1e-10;
  options.min_lm_diagonal = 1e-3;  // steps stay short in directions that hardly any residual sees
  options.logging_type = ceres::SILENT;
  return options;
}

class IterationProgress final : public ceres::IterationCallback {
 public:
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& /*summary*/) override {
    progress_.Step();
    return ceres::SOLVER_CONTINUE;
  }

 private:
  Progress progress_{"iterations", Progress::kUnknownCount};
};

}  // namespace

BackEndProblem::BackEndProblem(const BackEndInput& input, const OptimiseOptions& options,
                               int threads)
    : input_(input),
      options_(options),
      threads_(threads),
      detections_by_object_(DetectionsByObject(input.sequence)),
      variables_(input),
      loss_(options.upright.huber_delta),
      problem_({.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP,  // they outlive it
                .enable_fast_removal = true}) {
  WeighViews();
  if (!options.hold_poses) AddOdometry();
  for (size_t i = 0; i < input.initial_landmarks.size(); ++i) {
    if (input.initial_landmarks[i]) AddLandmark(i);
  }
  AddDetections();
  SetManifolds();
  if (problem_.HasParameterBlock(variables_.LogFocal())) {
    problem_.SetParameterBlockConstant(variables_.LogFocal());
  }
}

Landmark BackEndProblem::LandmarkInCamera(const Detection& detection) const {
  return Transform(variables_.PoseValue(detection.frame_index).Inverse(),
                   variables_.LandmarkValue(detection.object_index));
}

void BackEndProblem::WeighViews() {
  view_weights_.assign(input_.sequence.detections.size(), 1.0);
  for (size_t i = 0; i < detections_by_object_.size(); ++i) {
    if (!input_.initial_landmarks[i]) continue;
    const std::vector<int>& detections = detections_by_object_[i];
    std::vector<Eigen::Vector3d> directions;
    for (const int index : detections) {
      directions.push_back(
          input_.initial_landmarks[i]->Centre() -
          input_.sequence.FrameOf(input_.sequence.detections[index]).world_from_camera.translation);
    }
    const auto weights = DirectionWeights(directions, options_.upright.ViewCorrelation());
    for (size_t k = 0; k < weights.size(); ++k) {
      view_weights_[detections[k]] = weights[k];
    }
  }
}

void BackEndProblem::AddOdometry() {
  const auto& frames = input_.sequence.frames;
  for (size_t i = 1; i < frames.size(); ++i) {
    if (frames[i].segment != frames[i - 1].segment) continue;
    const Rigid3d first_from_second =
        frames[i - 1].world_from_camera.Inverse() * frames[i].world_from_camera;
    problem_.AddResidualBlock(new OdometryResidual(first_from_second, options_.Odometry()), &loss_,
                              variables_.Pose(i - 1), variables_.Pose(i));
    ++summary_.residuals["odometry"];
  }
}

// An estimated plane moves with the objects on it, under the priors of its normal and height. No
// loss: a body that floats is not an outlier, but wrong.
void BackEndProblem::AddStanding(size_t object_index) {
  const auto plane_index = static_cast<size_t>(input_.sequence.objects[object_index].plane_index);
  double* normal = variables_.Normal(plane_index);
  double* offset = variables_.Offset(plane_index);
  const bool is_new_normal = !problem_.HasParameterBlock(normal);
  const bool is_new_plane = !problem_.HasParameterBlock(offset);
  const double side = variables_.NormalSide(plane_index);
  const auto& prior = input_.priors[object_index];
  const bool may_lean = prior && prior->attitude == Attitude::kFree;
  StandingSigmas sigmas{.height_m = options_.standing_height_sigma_m};
  if (!may_lean) sigmas.angle_rad = options_.standing_angle_sigma_deg * kRadPerDeg;
  problem_.AddResidualBlock(
      new StandingOnPlaneResidual(input_.initial_landmarks[object_index]->shape_exponents, sigmas,
                                  may_lean, side),
      nullptr, variables_.Landmark(object_index), normal, offset);
  const SupportPlane& plane = input_.sequence.planes[plane_index];
  if (!plane.attitude_information || !options_.refine_planes) {
    problem_.SetParameterBlockConstant(normal);
    problem_.SetParameterBlockConstant(offset);
    return;
  }
  if (is_new_normal) {
    problem_.AddResidualBlock(PlaneNormalPrior(*plane.attitude_information).release(), nullptr,
                              normal);
  }
  if (is_new_plane && plane.height_prior) {
    problem_.AddResidualBlock(new PlaneHeightResidual(*plane.height_prior, side), nullptr, normal,
                              offset);
  }
}

void BackEndProblem::AddLandmark(size_t object_index) {
  const Object& object = input_.sequence.objects[object_index];
  double* landmark = variables_.Landmark(object_index);
  if (options_.support) {
    if (IsTangency()) {
      AddStanding(object_index);
    } else {
      const Plane& plane = input_.sequence.planes[object.plane_index].plane_in_world;
      problem_.AddResidualBlock(new SupportResidual(plane, options_.variances.SupportAngleRad2(),
                                                    options_.variances.SupportTangencyM4()),
                                &loss_, landmark);
    }
    ++summary_.residuals["support"];
  }
  const std::vector<PictureView> pictures =
      PicturesInWorld(input_.sequence, detections_by_object_[object_index]);
  const auto prior = PriorWithPictures(input_.priors[object_index], pictures);
  if (options_.ratio) {
    ++(prior ? summary_.residuals["ratio"] : summary_.gated["object_without_ratio"]);
  }
  const Landmark& initial = *input_.initial_landmarks[object_index];
  if (!IsTangency()) {
    if (!options_.ratio || !prior) return;
    const Eigen::Vector2d ratio = OnFace(*prior, initial.rests_on).ratio;
    problem_.AddResidualBlock(new ScaleRatioResidual(ratio, options_.variances.ratio), &loss_,
                              landmark);
    return;
  }
  ObjectEvidence evidence;
  evidence.ratio_is_free = !options_.ratio;
  if (prior) evidence.prior = OnFace(*prior, initial.rests_on);
  // Yaws are about the normal of a plane: without one, neither axes nor pictures tell them.
  if (object.plane_index != kNoPlane) {
    const SupportPlane& support = input_.sequence.planes[object.plane_index];
    evidence.plane = support.plane_in_world;
    evidence.scene_axis = support.scene_axis_in_world;
    evidence.axes_weight = options_.upright.axes_weight;
    evidence.picture_costs = PictureCosts(pictures, evidence.plane);
  }
  // No loss: a ratio far from the prior is as unlikely as its spread says.
  for (auto& term : PriorTerms(evidence)) {
    problem_.AddResidualBlock(new LandmarkTermResidual(std::move(term), initial.shape_exponents),
                              nullptr, landmark);
  }
}

void BackEndProblem::AddDetections() {
  int added = 0;
  for (size_t i = 0; i < input_.sequence.detections.size(); ++i) {
    const Detection& detection = input_.sequence.detections[i];
    if (!input_.initial_landmarks[detection.object_index]) {
      ++summary_.gated[input_.sequence.ObjectOf(detection).is_static
                           ? "detection_of_object_without_start"
                           : "detection_of_moving_object"];
      continue;
    }
    const Landmark initial_in_camera = LandmarkInCamera(detection);
    if (!(initial_in_camera.Centre().z() > 0.0)) {
      ++summary_.gated["landmark_behind_camera"];
      continue;
    }
    AddDetection(i, initial_in_camera);
    ++added;
  }
  if (added > 0) summary_.residuals["detection"] = added;
  if (!IsTangency()) return;
  // The bias of each side that some box has: normal about zero, or zero where its sigma is.
  const double sigma_px = options_.detector_bias_sigma_px;
  for (size_t side = 0; side < 4; ++side) {
    double* bias = variables_.Bias(side);
    if (!problem_.HasParameterBlock(bias)) continue;
    if (sigma_px > 0.0) {
      const ceres::Matrix weight = ceres::Matrix::Constant(1, 1, 1.0 / sigma_px);
      problem_.AddResidualBlock(new ceres::NormalPrior(weight, ceres::Vector::Zero(1)), nullptr,
                                bias);
    } else {
      problem_.SetParameterBlockConstant(bias);
    }
  }
}

void BackEndProblem::AddDetection(size_t index, const Landmark& initial_in_camera) {
  const Detection& detection = input_.sequence.detections[index];
  if (!IsTangency()) {
    const Camera& camera = input_.sequence.CameraOf(detection);
    box_blocks_.push_back(problem_.AddResidualBlock(
        new DetectionResidual(camera, detection.box, options_.variances.DetectionM4()), &loss_,
        Pose(detection), LandmarkOf(detection)));
    summary_.expected_box_cost += 0.5 * 4.0;
    return;
  }
  view_losses_.emplace_back(&loss_, view_weights_[index], ceres::DO_NOT_TAKE_OWNERSHIP);
  const auto edges = MakeBoxEdges(input_.sequence, detection, input_.priors[detection.object_index],
                                  options_.upright);
  for (size_t side = 0; side < edges.size(); ++side) {
    // A body so near that it reaches behind the camera has no tangent point in view.
    if (!(FindTangentDepth(edges[side], initial_in_camera).depth_m > 0.0)) {
      ++summary_.gated["edge_behind_camera"];
      continue;
    }
    box_blocks_.push_back(problem_.AddResidualBlock(
        new TangencyResidual(edges[side], initial_in_camera), &view_losses_.back(), Pose(detection),
        LandmarkOf(detection), variables_.Bias(side), variables_.LogFocal()));
    summary_.expected_box_cost += 0.5 * view_weights_[index];
  }
}

void BackEndProblem::SetManifolds() {
  const auto set = [&](double* block, ceres::Manifold* (*make)()) {
    if (problem_.HasParameterBlock(block) && !problem_.HasManifold(block)) {
      problem_.SetManifold(block, make());
    }
  };
  const auto& frames = input_.sequence.frames;
  for (size_t i = 0; i < frames.size(); ++i) {
    set(variables_.Pose(i), NewPoseManifold);
    // The first pose of each segment defines its world.
    const bool is_first = i == 0 || frames[i].segment != frames[i - 1].segment;
    if ((options_.hold_poses || is_first) && problem_.HasParameterBlock(variables_.Pose(i))) {
      problem_.SetParameterBlockConstant(variables_.Pose(i));
    }
  }
  for (size_t i = 0; i < input_.initial_landmarks.size(); ++i) {
    set(variables_.Landmark(i), NewLandmarkManifold);
  }
  for (size_t i = 0; i < input_.sequence.planes.size(); ++i) {
    set(variables_.Normal(i), NewNormalManifold);
  }
}

void BackEndProblem::Solve(int max_iterations) {
  const ceres::Solver::Summary solution = Minimise(std::min(max_iterations, IterationsLeft()));
  if (!solution.IsSolutionUsable()) throw NumericalError("back end: " + solution.message);
  std::vector<double>& costs = summary_.cost_per_iteration;
  if (costs.empty()) summary_.initial_cost = solution.initial_cost;
  summary_.final_cost = solution.final_cost;
  summary_.box_cost = BoxCost();
  summary_.iterations += static_cast<int>(std::max<size_t>(1, solution.iterations.size())) - 1;
  summary_.converged = solution.termination_type == ceres::CONVERGENCE;
  summary_.detector_bias_px = variables_.BiasValues();
  double lowest = solution.initial_cost;
  for (const ceres::IterationSummary& iteration : solution.iterations) {
    // Ceres gives a rejected step the cost where it would have led.
    if (iteration.step_is_successful) lowest = std::min(lowest, iteration.cost);
    costs.push_back(lowest);
  }
}

ceres::Solver::Summary BackEndProblem::Minimise(int max_iterations, double least_tolerance) {
  ceres::Solver::Options options = SolverOptions(max_iterations);
  ChooseLinearSolver(problem_, &options);
  if (IsTangency() && !(image_blocks_.empty() && point_blocks_.empty())) {
    // The costs of images have kinks at pixels: every step that crosses one may be refused.
    options.use_nonmonotonic_steps = true;
    options.function_tolerance = 1e-6;
  } else {
    // Drift is the sum of many small steps of poses, which more damping would shorten.
    if (IsTangency()) options.initial_trust_region_radius = 1e8;
    // A landmark that its boxes hardly determine would shorten the steps of all others: after each
    // step, each is optimised alone.
    options.inner_iteration_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
    for (size_t i = 0; i < input_.initial_landmarks.size(); ++i) {
      double* landmark = variables_.Landmark(i);
      if (!problem_.HasParameterBlock(landmark)) continue;
      options.inner_iteration_ordering->AddElementToGroup(landmark, 0);
    }
    options.use_inner_iterations =
        options.inner_iteration_ordering->NumElements() > 0 && VariableBlocks(problem_).size() > 1;
  }
  options.function_tolerance = std::max(options.function_tolerance, least_tolerance);
  // Ceres ends inner iterations for good once they gain less than this: as soon as a step would.
  options.inner_iteration_tolerance = options.function_tolerance;
  IterationProgress progress;
  options.callbacks.push_back(&progress);
  ceres::Solver::Summary solution;
  ceres::Solve(options, &problem_, &solution);
  return solution;
}

double BackEndProblem::BoxCost() {
  double cost = 0.0;
  ceres::Problem::EvaluateOptions boxes;
  boxes.residual_blocks = box_blocks_;
  if (!box_blocks_.empty()) {  // which would mean all
    problem_.Evaluate(boxes, &cost, nullptr, nullptr, nullptr);
  }
  return cost;
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/back_end.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "constraints/detection.h"
#include "constraints/manifolds.h"
#include "constraints/odometry.h"
#include "constraints/scale_ratio.h"
#include "constraints/support.h"
#include "initialisation/single_frame.h"
#include "mapping/covariance.h"
#include "symmetry/sampling.h"

namespace soslam {
namespace {

// The one problem of eq. (1), its variables, and what went into it.
class BackEndProblem {
 public:
  BackEndProblem(const BackEndInput& input, const OptimiseOptions& options)
      : input_(input), options_(options), loss_(options.huber_delta), problem_(BorrowLoss()) {
    for (const Frame& frame : input.sequence.frames)
      poses_.push_back(Pack(frame.world_from_camera));
    for (const auto& start : input.starts) landmarks_.push_back(Pack(start.value_or(Landmark())));
    for (PoseBlock& pose : poses_) {
      problem_.AddParameterBlock(pose.data(), kPoseSize, NewPoseManifold());
    }
    problem_.SetParameterBlockConstant(poses_.front().data());
    AddOdometry();
    for (size_t i = 0; i < landmarks_.size(); ++i) {
      if (input.starts[i]) AddLandmark(i);
    }
    AddDetections();
  }

  // Which surface points see each other in the mirror depends on the landmarks: texture joins in
  // when boxes and planes have settled.
  void AddSymmetry() {
    for (const auto& [detection_index, image] : input_.symmetry_images) {
      AddSymmetry(input_.sequence.detections[static_cast<size_t>(detection_index)], image);
    }
  }

  // Minimises from where the variables are.
  void Solve() {
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::SPARSE_SCHUR;
    solver.max_num_iterations = options_.max_iterations;
    // A pixel is a residual of 1e-3 or less: the default tolerances would stop far from the
    // optimum.
    solver.function_tolerance = 1e-8;
    solver.gradient_tolerance = 1e-14;
    solver.parameter_tolerance = 1e-10;
    solver.num_threads = 1;  // for identical bytes from run to run
    solver.logging_type = ceres::SILENT;
    solver.linear_solver_ordering = LandmarkOrdering();
    // A landmark that its boxes hardly determine would shrink the one trust region of them all:
    // after every step each is optimised for itself.
    solver.use_inner_iterations = true;
    solver.inner_iteration_ordering = LandmarkOrdering();
    for (PoseBlock& pose : poses_) solver.linear_solver_ordering->AddElementToGroup(pose.data(), 1);

    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem_, &summary);
    if (!summary.IsSolutionUsable()) throw NumericalError("back end: " + summary.message);
    if (summary_.cost_per_iteration.empty()) summary_.initial_cost = summary.initial_cost;
    summary_.final_cost = summary.final_cost;
    summary_.iterations += static_cast<int>(summary.iterations.size()) - 1;
    summary_.converged = summary.termination_type == ceres::CONVERGENCE;
    for (const auto& iteration : summary.iterations) {
      summary_.cost_per_iteration.push_back(iteration.cost);
    }
  }

  const SolverSummary& summary() const { return summary_; }
  ceres::Problem& problem() { return problem_; }
  const double* LandmarkData(size_t object_index) const { return landmarks_[object_index].data(); }
  const std::vector<PoseBlock>& poses() const { return poses_; }

 private:
  // Residual blocks share one loss, which outlives the problem.
  static ceres::Problem::Options BorrowLoss() {
    ceres::Problem::Options options;
    options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    return options;
  }

  std::shared_ptr<ceres::ParameterBlockOrdering> LandmarkOrdering() {
    auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
    for (size_t i = 0; i < landmarks_.size(); ++i) {
      if (input_.starts[i]) ordering->AddElementToGroup(landmarks_[i].data(), 0);
    }
    return ordering;
  }

  void AddOdometry() {
    const auto& frames = input_.sequence.frames;
    for (size_t i = 1; i < frames.size(); ++i) {
      const Rigid3d first_from_second =
          frames[i - 1].world_from_camera.Inverse() * frames[i].world_from_camera;
      problem_.AddResidualBlock(
          new OdometryResidual(first_from_second,
                               options_.odometry_rotation_sigma_deg * std::numbers::pi / 180.0,
                               options_.odometry_translation_sigma_m),
          &loss_, poses_[i - 1].data(), poses_[i].data());
      ++summary_.residuals["odometry"];
    }
  }

  void AddLandmark(size_t object_index) {
    const Object& object = input_.sequence.objects[object_index];
    double* landmark = landmarks_[object_index].data();
    problem_.AddParameterBlock(landmark, kLandmarkSize, NewLandmarkManifold());
    if (options_.support) {
      const Plane& plane =
          input_.sequence.planes[static_cast<size_t>(object.plane_index)].plane_in_world;
      problem_.AddResidualBlock(new SupportResidual(plane, options_.variances.SupportAngleRad2(),
                                                    options_.variances.SupportTangencyM4()),
                                &loss_, landmark);
      ++summary_.residuals["support"];
    }
    if (options_.ratio && input_.ratios[object_index]) {
      problem_.AddResidualBlock(
          new ScaleRatioResidual(*input_.ratios[object_index], options_.variances.ratio), &loss_,
          landmark);
      ++summary_.residuals["ratio"];
    } else if (options_.ratio) {
      ++summary_.gated["object_without_ratio"];
    }
  }

  void AddDetections() {
    for (const Detection& detection : input_.sequence.detections) {
      const auto object_index = static_cast<size_t>(detection.object_index);
      if (!input_.starts[object_index]) {
        ++summary_.gated["detection_of_object_without_start"];
        continue;
      }
      if (!LandmarkInCamera(detection).has_value()) {
        ++summary_.gated["landmark_behind_camera"];
        continue;
      }
      problem_.AddResidualBlock(new DetectionResidual(input_.sequence.camera, detection.box,
                                                      options_.variances.DetectionM4()),
                                &loss_, poses_[static_cast<size_t>(detection.frame_index)].data(),
                                landmarks_[object_index].data());
      ++summary_.residuals["detection"];
    }
  }

  void AddSymmetry(const Detection& detection, const std::shared_ptr<const SymmetryImage>& image) {
    const auto object_index = static_cast<size_t>(detection.object_index);
    if (!input_.starts[object_index]) return;
    PoseBlock& pose = poses_[static_cast<size_t>(detection.frame_index)];
    LandmarkBlock& landmark = landmarks_[object_index];
    const Landmark in_camera =
        Transform(UnpackPose(pose.data()).Inverse(), UnpackLandmark(landmark.data()));
    const Camera& camera = input_.sequence.camera;
    const SymmetryOptions& symmetry = options_.symmetry_options;
    const SymmetryDescriptor at_start(symmetry.descriptor, *image, camera, in_camera);
    std::vector<Eigen::Vector2d> visible;
    for (const Eigen::Vector2d& pixel :
         SamplePixels(image->maps, camera, in_camera, detection.box, symmetry)) {
      if (at_start.Evaluate(pixel, symmetry.min_viewing_cosine, false)) visible.push_back(pixel);
    }
    if (visible.size() < static_cast<size_t>(symmetry.min_pairs)) {
      ++summary_.gated["symmetry_with_too_few_visible_pairs"];
      return;
    }
    for (const Eigen::Vector2d& pixel : visible) {
      problem_.AddResidualBlock(
          new SymmetryResidual(symmetry.descriptor, image, camera, pixel, options_.symmetry_sigma),
          &loss_, pose.data(), landmark.data());
    }
    summary_.residuals["symmetry"] += static_cast<int>(visible.size());
  }

  // The start of a detection's landmark as its camera sees it; none unless its centre is in front.
  std::optional<Landmark> LandmarkInCamera(const Detection& detection) const {
    const auto& start = input_.starts[static_cast<size_t>(detection.object_index)];
    if (!start) return std::nullopt;
    const auto& frame = input_.sequence.frames[static_cast<size_t>(detection.frame_index)];
    const Landmark in_camera = Transform(frame.world_from_camera.Inverse(), *start);
    return in_camera.Centre().z() > 0.0 ? std::optional(in_camera) : std::nullopt;
  }

  const BackEndInput& input_;
  const OptimiseOptions& options_;
  ceres::HuberLoss loss_;
  ceres::Problem problem_;
  std::vector<PoseBlock> poses_;
  std::vector<LandmarkBlock> landmarks_;
  SolverSummary summary_;
};

void AddCovariances(BackEndProblem* problem, MapEstimate* map) {
  std::vector<const double*> blocks;
  std::vector<ObjectEstimate*> objects;
  for (ObjectEstimate& object : map->objects) {
    if (!object.landmark_in_world) continue;
    blocks.push_back(problem->LandmarkData(static_cast<size_t>(object.object_index)));
    objects.push_back(&object);
  }
  const auto covariances = LandmarkCovariances(blocks, &problem->problem());
  if (!covariances) {
    map->solver.gated["covariance_of_undetermined_problem"] = static_cast<int>(objects.size());
    return;
  }
  for (size_t i = 0; i < objects.size(); ++i) objects[i]->covariance = (*covariances)[i];
}

// The median over the object's detections of the distance between box and outline; large where the
// outline does not exist.
double MedianEdgeRms(const Sequence& sequence, const std::vector<int>& detections,
                     const Landmark& landmark_in_world) {
  std::vector<double> distances;
  for (const int index : detections) {
    const Detection& detection = sequence.detections[static_cast<size_t>(index)];
    const Frame& frame = sequence.frames[static_cast<size_t>(detection.frame_index)];
    distances.push_back(OutlineEdgeRms(
        sequence.camera, Transform(frame.world_from_camera.Inverse(), landmark_in_world),
        detection.box));
  }
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

}  // namespace

MapEstimate OptimiseMap(const BackEndInput& input, const OptimiseOptions& options) {
  BackEndProblem problem(input, options);
  MapEstimate map;
  problem.Solve();
  if (!input.symmetry_images.empty()) {
    problem.AddSymmetry();
    problem.Solve();
  }
  map.solver = problem.summary();
  for (const PoseBlock& pose : problem.poses()) {
    map.world_from_camera.push_back(UnpackPose(pose.data()));
  }
  const auto detections = DetectionsByObject(input.sequence);
  for (size_t i = 0; i < input.starts.size(); ++i) {
    ObjectEstimate object;
    object.object_index = static_cast<int>(i);
    object.observations = static_cast<int>(detections[i].size());
    if (input.starts[i]) {
      object.landmark_in_world = UnpackLandmark(problem.LandmarkData(i));
    } else {
      object.failure = "no_start";
    }
    map.objects.push_back(object);
  }
  if (options.covariances) AddCovariances(&problem, &map);
  return map;
}

std::vector<std::optional<Landmark>> ChooseStarts(const Sequence& sequence,
                                                  const LandmarkEstimates& estimates) {
  const auto detections = DetectionsByObject(sequence);
  std::vector<std::optional<Landmark>> starts(sequence.objects.size());
  std::vector<double> distances(sequence.objects.size(), std::numeric_limits<double>::infinity());
  for (const ObservationEstimate& observation : estimates.observations) {
    if (observation.hypotheses.empty()) continue;
    const Detection& detection =
        sequence.detections[static_cast<size_t>(observation.detection_index)];
    const auto object_index = static_cast<size_t>(detection.object_index);
    const Frame& frame = sequence.frames[static_cast<size_t>(detection.frame_index)];
    for (const Hypothesis& hypothesis : observation.hypotheses) {
      const Landmark in_world = Transform(frame.world_from_camera, hypothesis.landmark_in_camera);
      const double distance = MedianEdgeRms(sequence, detections[object_index], in_world);
      if (!starts[object_index] || distance < distances[object_index]) {
        starts[object_index] = in_world;
        distances[object_index] = distance;
      }
    }
  }
  for (const ObjectEstimate& object : estimates.objects) {
    if (object.landmark_in_world) {
      starts[static_cast<size_t>(object.object_index)] = object.landmark_in_world;
    }
  }
  return starts;
}

}  // namespace soslam

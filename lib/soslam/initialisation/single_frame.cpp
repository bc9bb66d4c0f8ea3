// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/initialisation/single_frame.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "soslam/constraints/parameters.h"
#include "soslam/constraints/quadric_constraints.h"
#include "soslam/geometry/angles.h"
#include "soslam/model/occlusion.h"

namespace soslam {
namespace {

// Solutions closer than this are the same.
constexpr double kSameYaw = 0.5 * kRadPerDeg;
constexpr double kSameRelativeSize = 1e-2;

// Initial guess of the prior's ratio where the box's lower edge meets the plane, as large as the
// box is wide there. The caller sets its yaw.
std::optional<Landmark> Start(const SingleFrameObservation& observation) {
  const Plane& plane = observation.plane_in_camera;
  const Box& box = observation.box;
  const auto foot = GroundContactInCamera(observation.camera, box, plane);
  if (!foot) return std::nullopt;

  const Eigen::Vector2d& ratio = observation.ratio;
  const double half_width = 0.5 * box.Width() * foot->z() / observation.camera.fx;
  const double c = half_width / std::sqrt(0.5 * ratio.squaredNorm());
  Landmark start;
  start.half_axes = {ratio.x() * c, ratio.y() * c, c};
  start.frame_from_object.translation =
      *foot + c * plane.normal + half_width * Eigen::Vector3d::UnitZ();
  return start;
}

// Adds the constraints of eq. (12) on a landmark in the camera frame. The caller owns the blocks;
// the camera block must be the identity, and is set constant.
void AddSingleFrameConstraints(const SingleFrameObservation& observation,
                               const ConstraintVariances& variances, PoseBlock* camera,
                               LandmarkBlock* landmark, ceres::Problem* problem) {
  problem->AddParameterBlock(landmark->data(), kLandmarkSize, NewLandmarkManifold());
  problem->AddResidualBlock(
      new DetectionResidual(observation.camera, observation.box, variances.DetectionM4()), nullptr,
      camera->data(), landmark->data());
  problem->AddResidualBlock(
      new SupportResidual(observation.plane_in_camera, variances.SupportAngleRad2(),
                          variances.SupportTangencyM4()),
      nullptr, landmark->data());
  problem->AddResidualBlock(new ScaleRatioResidual(observation.ratio, variances.ratio), nullptr,
                            landmark->data());
  problem->SetParameterBlockConstant(camera->data());
}

Hypothesis Solve(const SingleFrameObservation& observation, const SingleFrameOptions& options,
                 const Landmark& start) {
  LandmarkBlock landmark = ToParameterBlock(start);
  PoseBlock camera = ToParameterBlock(Rigid3d());
  ceres::Problem problem;
  AddSingleFrameConstraints(observation, options.variances, &camera, &landmark, &problem);

  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.max_num_iterations = options.max_iterations;
  // An error of one pixel is a residual of 1e-3 or less: the default tolerances would stop far from
  // the optimum.
  solver.function_tolerance = 1e-12;
  solver.gradient_tolerance = 1e-16;
  solver.parameter_tolerance = 1e-10;
  solver.num_threads = 1;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  return {UnpackLandmark(landmark.data()), summary.IsSolutionUsable()
                                               ? summary.final_cost
                                               : std::numeric_limits<double>::infinity()};
}

bool IsPlausible(const SingleFrameObservation& observation, const Hypothesis& hypothesis) {
  const Landmark& landmark = hypothesis.landmark_in_camera;
  const Plane& plane = observation.plane_in_camera;
  const Eigen::Vector3d up = landmark.frame_from_object.rotation * Eigen::Vector3d::UnitZ();
  return std::isfinite(hypothesis.cost) && up.dot(plane.normal) > 0.5 &&
         plane.SignedDistance(landmark.Centre()) > 0.0 &&
         OutlineBox(observation.camera, landmark).has_value();
}

}  // namespace

double SingleFrameCost(const SingleFrameObservation& observation,
                       const ConstraintVariances& variances, const Landmark& landmark_in_camera) {
  LandmarkBlock landmark = ToParameterBlock(landmark_in_camera);
  PoseBlock camera = ToParameterBlock(Rigid3d());
  ceres::Problem problem;
  AddSingleFrameConstraints(observation, variances, &camera, &landmark, &problem);
  double cost = 0.0;
  return problem.Evaluate(ceres::Problem::EvaluateOptions(), &cost, nullptr, nullptr, nullptr)
             ? cost
             : std::numeric_limits<double>::infinity();
}

ObservationEstimate InitialiseFromSingleFrame(const SingleFrameObservation& observation,
                                              const SingleFrameOptions& options) {
  auto start = Start(observation);
  if (!start) return {0, {}, "support_plane_not_in_view"};

  std::vector<Hypothesis> found;
  for (int i = 0; i < options.yaw_starts; ++i) {
    const Plane& plane = observation.plane_in_camera;
    start->frame_from_object.rotation =
        UprightRotation(plane.normal, i * std::numbers::pi / options.yaw_starts);
    const Hypothesis hypothesis = Solve(observation, options, *start);
    if (!IsPlausible(observation, hypothesis)) continue;
    const auto same = std::ranges::find_if(found, [&](const Hypothesis& other) {
      const Landmark& one = hypothesis.landmark_in_camera;
      const Landmark& two = other.landmark_in_camera;
      const double turn = YawDifferenceModuloPi(Yaw(plane.normal, one.frame_from_object.rotation),
                                                Yaw(plane.normal, two.frame_from_object.rotation));
      const Eigen::Array3d relative_sizes = one.half_axes.array() / two.half_axes.array();
      return std::abs(turn) < kSameYaw &&
             (relative_sizes - 1.0).abs().maxCoeff() < kSameRelativeSize;
    });
    if (same == found.end()) {
      found.push_back(hypothesis);
    } else if (hypothesis.cost < same->cost) {
      *same = hypothesis;
    }
  }
  if (found.empty()) return {0, {}, "no_solution"};

  std::ranges::sort(found, {}, &Hypothesis::cost);
  const auto edge_rms = [&](const Hypothesis& hypothesis) {
    return OutlineEdgeRms(observation.camera, hypothesis.landmark_in_camera, observation.box);
  };
  const double tied_rms = edge_rms(found.front()) + options.tie_edge_px;
  const auto tied_end = std::stable_partition(
      found.begin(), found.end(),
      [&](const Hypothesis& hypothesis) { return edge_rms(hypothesis) <= tied_rms; });
  // 0 if the x axis is along the preferred direction or, for the scene's axes, at right angles to
  // it.
  const auto oddity = [&](const Hypothesis& hypothesis) {
    const Landmark& landmark = hypothesis.landmark_in_camera;
    const auto& axis = observation.scene_axis_in_camera;
    const bool scene_axes = options.tie_break == TieBreak::kSceneAxes && axis;
    const Eigen::Vector3d preferred = scene_axes ? *axis : landmark.Centre();
    const Eigen::Vector2d front =
        (landmark.frame_from_object.rotation.conjugate() * preferred).head<2>().normalized();
    return scene_axes ? std::abs(front.x() * front.y()) : std::abs(front.y());
  };
  std::ranges::stable_sort(found.begin(), tied_end, {}, oddity);
  return {0, found, ""};
}

}  // namespace soslam

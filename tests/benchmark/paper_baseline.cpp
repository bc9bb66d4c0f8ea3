// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/paper_baseline.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "benchmark/paper_residuals.h"
#include "soslam/geometry/angles.h"

namespace soslam::paper {
namespace {

// Sigma_det, Sigma_theta and Sigma_pi of the paper are 10, in one frame in decimetres and degrees,
// in the back end in metres and degrees: see docs/paper.md. It has no number for texture; of 30,
// 3, 1, 0.3, 0.1 and 0.03 m this one gives the highest IoU with these inputs.
constexpr double kSingleFrameVariance = 1e-3;  // m^4
constexpr double kAllFramesVariance = 10.0;    // m^4
constexpr double kAngleVariance = 10.0 * kRadPerDeg * kRadPerDeg;
constexpr double kSymmetrySigma = 3.0;  // m
// Odometry between two frames.
constexpr double kRotationSigma = 0.1 * kRadPerDeg;
constexpr double kTranslationSigma = 0.003;  // m
constexpr double kHuberDelta = 1.0;

class Optimiser {
 public:
  // A null loss is none.
  Optimiser(const Observations& observations, const Landmark& start, double variance,
            ceres::LossFunction* loss)
      : observations_(observations),
        start_(start),
        weight_(1.0 / std::sqrt(variance)),
        loss_(loss),
        problem_(BorrowLoss()),
        poses_(observations.views.size()) {
    // The paper counts one texture; that of several weighs as much together.
    const auto textures = std::ranges::count_if(
        observations.views, [](const View& view) { return view.edge_maps != nullptr; });
    symmetry_weight_ = 1.0 / (kSymmetrySigma * std::sqrt(static_cast<double>(textures)));
    problem_.AddResidualBlock(
        new ceres::NumericDiffCostFunction<PriorResiduals, ceres::CENTRAL, 5, kLandmarkSize>(
            new PriorResiduals{observations.plane_in_world, observations.ratio, start,
                               1.0 / std::sqrt(kAngleVariance), weight_}),
        loss_, landmark_.data());
    for (size_t i = 0; i < poses_.size(); ++i) AddView(i);
    problem_.SetParameterBlockConstant(poses_[0].data());
  }

  void AddOdometry() {
    for (size_t i = 1; i < poses_.size(); ++i) {
      problem_.AddResidualBlock(
          new ceres::NumericDiffCostFunction<OdometryResiduals, ceres::CENTRAL, 6, kPoseSize,
                                             kPoseSize>(
              new OdometryResiduals{observations_.views[i - 1].world_from_camera,
                                    observations_.views[i].world_from_camera, 1.0 / kRotationSigma,
                                    1.0 / kTranslationSigma}),
          loss_, poses_[i - 1].data(), poses_[i].data());
    }
  }

  Solution Solve() {
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.max_num_iterations = 100;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem_, &summary);
    const Ellipsoid ellipsoid(start_, landmark_.data());
    return {{{Eigen::Quaterniond(ellipsoid.rotation), ellipsoid.centre}, ellipsoid.half_axes},
            summary.final_cost,
            static_cast<int>(summary.iterations.size()) - 1};
  }

 private:
  static ceres::Problem::Options BorrowLoss() {
    ceres::Problem::Options options;
    options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    return options;
  }

  void AddView(size_t index) {
    const View& view = observations_.views[index];
    problem_.AddResidualBlock(
        new ceres::NumericDiffCostFunction<DetectionResiduals, ceres::CENTRAL, 4, kPoseSize,
                                           kLandmarkSize>(
            new DetectionResiduals{observations_.camera, view, start_, weight_}),
        loss_, poses_[index].data(), landmark_.data());
    if (view.edge_maps == nullptr) return;
    auto residuals =
        std::make_unique<SymmetryResiduals>(observations_.camera, view, start_, symmetry_weight_);
    const int count = residuals->NumResiduals();
    if (count == 0) return;
    auto* cost = new ceres::DynamicNumericDiffCostFunction<SymmetryResiduals, ceres::CENTRAL>(
        residuals.release());
    cost->AddParameterBlock(kPoseSize);
    cost->AddParameterBlock(kLandmarkSize);
    cost->SetNumResiduals(count);
    // Far below the Huber threshold, pair by pair.
    problem_.AddResidualBlock(cost, nullptr, poses_[index].data(), landmark_.data());
  }

  const Observations& observations_;
  Landmark start_;
  double weight_;
  double symmetry_weight_;
  ceres::LossFunction* loss_;
  ceres::Problem problem_;
  std::array<double, kLandmarkSize> landmark_{};
  std::vector<std::array<double, kPoseSize>> poses_;
};

}  // namespace

std::optional<Landmark> Start(const Observations& observations, double yaw) {
  const View& view = observations.views.front();
  const Box& box = view.box;
  const Plane plane = Transform(view.world_from_camera.Inverse(), observations.plane_in_world);
  const Eigen::Vector3d foot_ray = observations.camera.Ray({box.Centre().x(), box.y_max});
  const double depth = -plane.offset / plane.normal.dot(foot_ray);
  if (!std::isfinite(depth) || !(depth > 0.0)) return std::nullopt;
  const double half_width = 0.5 * box.Width() * depth / observations.camera.fx;
  const double c = half_width / std::sqrt(0.5 * observations.ratio.squaredNorm());
  Landmark start;
  start.half_axes = {observations.ratio.x() * c, observations.ratio.y() * c, c};
  start.frame_from_object = {UprightRotation(observations.plane_in_world.normal, yaw),
                             view.world_from_camera * (depth * foot_ray + c * plane.normal +
                                                       half_width * Eigen::Vector3d::UnitZ())};
  return start;
}

Solution SolveSingleFrame(const Observations& observations, const Landmark& start_in_world) {
  return Optimiser(observations, start_in_world, kSingleFrameVariance, nullptr).Solve();
}

Solution SolveAllFrames(const Observations& observations, const Landmark& start_in_world) {
  ceres::HuberLoss loss(kHuberDelta);
  Optimiser optimiser(observations, start_in_world, kAllFramesVariance, &loss);
  optimiser.AddOdometry();
  return optimiser.Solve();
}

}  // namespace soslam::paper

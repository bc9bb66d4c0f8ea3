// SPDX-License-Identifier: BSD-3-Clause
#include "association/fit_object.h"

#include <Eigen/Dense>
#include <numbers>

#include "geometry/angles.h"
#include "initialisation/multi_view.h"
#include "initialisation/upright.h"
#include "initialisation/yaw_sweep.h"
#include "planes/standing_body.h"

namespace soslam {
namespace {

// The parameters of UprightVector and the height of the contact point over the plane (m), which is
// free without a plane.
constexpr int kMaxParameters = 7;
using Information =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxParameters, kMaxParameters>;
using ByParameters =
    Eigen::Matrix<double, kLandmarkDof, Eigen::Dynamic, 0, kLandmarkDof, kMaxParameters>;

// Weak prior that keeps the information regular, as standard deviations: yaw uniform over half a
// turn, contact point anywhere (m), log half axes 1.
Information PriorInformation(Eigen::Index parameters) {
  Eigen::Matrix<double, kMaxParameters, 1> sigmas;
  sigmas << std::numbers::pi / std::sqrt(12.0), 1e3, 1e3, 1.0, 1.0, 1.0, 1e3;
  return sigmas.head(parameters).array().square().inverse().matrix().asDiagonal();
}

ByParameters LandmarkByParameters(const MultiViewObservation& observation,
                                  const Landmark& landmark) {
  const Plane& plane = observation.plane_in_world;
  ByParameters by_parameters = ByParameters::Zero(kLandmarkDof, observation.height_is_free ? 7 : 6);
  by_parameters.leftCols<6>() = UprightGround(plane).ByParameters(landmark);
  if (observation.height_is_free) by_parameters.block<3, 1>(3, 6) = plane.normal;
  return by_parameters;
}

// Marginal covariance of the landmark including that of `up`: the landmark tilts with `up`, and its
// other parameters adapt so that it still fits the boxes.
Covariance9 CovarianceOf(const MultiViewObservation& observation, const Landmark& landmark,
                         const Eigen::Matrix3d& up_covariance) {
  const ByParameters by_parameters = LandmarkByParameters(observation, landmark);
  LandmarkModel model;
  for (const auto& term :
       observation.height_is_free ? OutlineTerms(observation) : ViewTerms(observation, landmark)) {
    term->AddTo(landmark, &model);
  }
  const Information information = PriorInformation(by_parameters.cols()) +
                                  by_parameters.transpose() * model.information * by_parameters;
  const Eigen::Matrix<double, Eigen::Dynamic, 3, 0, kMaxParameters, 3> mixed =
      by_parameters.transpose() * model.information.leftCols<3>();
  const Eigen::LDLT<Information> solver(information);
  Eigen::Matrix<double, kLandmarkDof, 3> by_turn = -by_parameters * solver.solve(mixed);
  by_turn.topRows<3>() += Eigen::Matrix3d::Identity();
  return by_parameters * solver.solve(ByParameters(by_parameters).transpose()) +
         by_turn * up_covariance * by_turn.transpose();
}

// Landmark from one box: the best yaw of a sweep.
std::optional<Landmark> LandmarkOnPlane(const Sequence& sequence, const Detection& detection,
                                        const MultiViewObservation& all,
                                        const AssociateOptions& options) {
  const Frame& frame = sequence.FrameOf(detection);
  UprightObservation observation = MakeUprightObservation(
      sequence, detection, *all.prior,
      {options.box_sigma_fraction, /*axes_weight=*/0.0, options.yaw_grid_deg});
  // The pose shared by all views, whereas the detection's own plane may come from a better pose.
  observation.plane_in_camera = Transform(frame.world_from_camera.Inverse(), all.plane_in_world);
  const YawObjective objective;
  const auto optima =
      LocalOptima(observation, objective,
                  SweepYaw(observation, objective, options.yaw_grid_deg * kRadPerDeg), 1);
  if (optima.empty()) return std::nullopt;
  return Transform(frame.world_from_camera, optima.front().landmark);
}

// Landmark from all views jointly. If that needs an initial guess, it is the first single-view
// landmark.
std::optional<Landmark> LandmarkOnPlane(const Sequence& sequence,
                                        const std::vector<int>& detections,
                                        const MultiViewObservation& observation,
                                        const AssociateOptions& options) {
  if (detections.size() > 1) {
    const auto solution = SolveViews(observation, options.yaw_grid_deg * kRadPerDeg);
    if (solution) return solution->landmark;
  }
  for (const int index : detections) {
    const Detection& detection = sequence.detections[static_cast<size_t>(index)];
    const auto start = LandmarkOnPlane(sequence, detection, observation, options);
    if (!start) continue;
    const auto solution = FitUpright(observation.plane_in_world, *start,
                                     ViewTerms(observation, *start), /*yaw_is_free=*/true);
    if (solution) return solution->landmark;
  }
  return std::nullopt;
}

}  // namespace

std::optional<FittedObject> FitObject(const Sequence& sequence, const std::vector<int>& detections,
                                      const ShapePrior& prior, const AssociateOptions& options,
                                      const std::optional<UpEstimate>& up) {
  const std::vector<int> used = SpreadOver(detections, static_cast<size_t>(options.max_views));
  MultiViewObservation observation = MakeMultiViewObservation(
      sequence, used, prior, options.box_sigma_fraction, options.view_correlation_deg * kRadPerDeg,
      /*height_is_free=*/up.has_value(), /*size_is_known=*/up.has_value());
  std::optional<Landmark> landmark;
  if (up) {
    const auto body =
        FitBodyAtFreeHeight(observation, up->up_in_world, options.yaw_grid_deg * kRadPerDeg);
    if (body) landmark = body->landmark;
    observation.plane_in_world = {up->up_in_world, 0.0};
  } else {
    landmark = LandmarkOnPlane(sequence, used, observation, options);
  }
  if (!landmark) return std::nullopt;
  const Covariance9 covariance =
      CovarianceOf(observation, *landmark, up ? up->covariance : Eigen::Matrix3d::Zero());
  if (!covariance.allFinite()) return std::nullopt;
  return FittedObject{*landmark, covariance};
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "association/fit_object.h"

#include <Eigen/Dense>
#include <numbers>

#include "initialisation/multi_view.h"
#include "initialisation/upright.h"
#include "initialisation/yaw_sweep.h"

namespace soslam {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;

// What is known without any box, as standard deviations: a yaw is somewhere on half a turn, the
// foot (m) anywhere, half axes to a factor of e.
UprightCovariance PriorInformation() {
  UprightVector sigmas;
  sigmas << std::numbers::pi / std::sqrt(12.0), 1e3, 1e3, 1.0, 1.0, 1.0;
  return sigmas.array().square().inverse().matrix().asDiagonal();
}

UprightCovariance CovarianceOf(const MultiViewObservation& observation, const Landmark& landmark) {
  const UprightJacobian by_parameters = UprightByParameters(observation.plane_in_world, landmark);
  UprightCovariance information = PriorInformation();
  for (const auto& term : ViewTerms(observation, landmark)) {
    Eigen::VectorXd residuals(term->NumResiduals());
    LandmarkTerm::Jacobian by_landmark(term->NumResiduals(), kLandmarkDof);
    term->Evaluate(landmark, residuals, &by_landmark);
    const Eigen::Matrix<double, Eigen::Dynamic, 6> jacobian = by_landmark * by_parameters;
    information += jacobian.transpose() * jacobian;
  }
  return information.ldlt().solve(UprightCovariance::Identity());
}

// From one box alone: the best yaw of a sweep.
std::optional<Landmark> LandmarkInWorld(const Sequence& sequence, const Detection& detection,
                                        const ShapePrior& prior, const AssociateOptions& options) {
  const Frame& frame = sequence.FrameOf(detection);
  UprightObservation observation = MakeUprightObservation(
      sequence, detection, prior,
      {options.box_sigma_fraction, /*axes_weight=*/0.0, options.yaw_grid_deg});
  // Of the same pose as all other views, while the detection's own may be of a better one.
  observation.plane_in_camera =
      Transform(frame.world_from_camera.Inverse(), PlaneOfDetection(sequence, detection));
  const YawObjective objective = BoxObjective(observation);
  const auto optima = LocalOptima(
      observation, objective, SweepYaw(observation, objective, options.yaw_grid_deg * kRadians), 1);
  if (optima.empty()) return std::nullopt;
  return Transform(frame.world_from_camera, optima.front().landmark);
}

// From all views at once; where these need a start, from the first one that gives one.
std::optional<Landmark> LandmarkInWorld(const Sequence& sequence,
                                        const std::vector<int>& detections,
                                        const MultiViewObservation& observation,
                                        const AssociateOptions& options) {
  if (detections.size() > 1) {
    const auto solution = SolveViews(observation, options.yaw_grid_deg * kRadians);
    if (solution) return solution->landmark;
  }
  for (const int index : detections) {
    const Detection& detection = sequence.detections[static_cast<size_t>(index)];
    const auto start = LandmarkInWorld(sequence, detection, *observation.prior, options);
    if (!start) continue;
    const auto solution = FitUpright(observation.plane_in_world, *start,
                                     ViewTerms(observation, *start), /*yaw_is_free=*/true);
    if (solution) return solution->landmark;
  }
  return std::nullopt;
}

}  // namespace

const Plane& PlaneOfDetection(const Sequence& sequence, const Detection& detection) {
  const auto plane_index = static_cast<size_t>(sequence.ObjectOf(detection).plane_index);
  return sequence.planes[plane_index].plane_in_world;
}

std::optional<FittedObject> FitObject(const Sequence& sequence, const std::vector<int>& detections,
                                      const ShapePrior& prior, const AssociateOptions& options) {
  const std::vector<int> used = SpreadOver(detections, static_cast<size_t>(options.max_views));
  const MultiViewObservation observation = MakeMultiViewObservation(
      sequence, used, prior, options.box_sigma_fraction, options.view_correlation_deg * kRadians);
  const auto landmark = LandmarkInWorld(sequence, used, observation, options);
  if (!landmark) return std::nullopt;
  const UprightCovariance covariance = CovarianceOf(observation, *landmark);
  if (!covariance.allFinite()) return std::nullopt;
  return FittedObject{*landmark, covariance};
}

}  // namespace soslam

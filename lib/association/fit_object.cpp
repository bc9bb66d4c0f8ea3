// SPDX-License-Identifier: BSD-3-Clause
#include "association/fit_object.h"

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "constraints/tangency.h"
#include "geometry/angles.h"
#include "initialisation/multi_view.h"
#include "initialisation/upright.h"
#include "initialisation/yaw_sweep.h"
#include "planes/standing_body.h"

namespace soslam {
namespace {

// The parameters of UprightVector and the height of the foot over the plane (m), which is
// free without a plane.
constexpr int kMaxParameters = 7;
using Information =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxParameters, kMaxParameters>;
using ParameterJacobian =
    Eigen::Matrix<double, kLandmarkDof, Eigen::Dynamic, 0, kLandmarkDof, kMaxParameters>;

// Weak prior that keeps the information regular, as standard deviations: yaw uniform over half a
// turn, foot anywhere (m), log half axes 1.
Information PriorInformation(Eigen::Index parameters) {
  Eigen::Matrix<double, kMaxParameters, 1> sigmas;
  sigmas << std::numbers::pi / std::sqrt(12.0), 1e3, 1e3, 1.0, 1.0, 1.0, 1e3;
  return sigmas.head(parameters).array().square().inverse().matrix().asDiagonal();
}

ParameterJacobian LandmarkByParameters(const MultiViewObservation& observation,
                                       const Landmark& landmark) {
  return UprightGround(observation.plane_in_world)
      .ParameterJacobianWithHeight(landmark)
      .leftCols(observation.height_is_free ? 7 : 6);
}

// Sum of the logarithms of the prior's standard deviations: its normalisation.
double LogNormalisation(const ShapePrior& prior) {
  const double conditional = 1.0 - prior.log_correlation * prior.log_correlation;
  return prior.log_sigma.array().log().sum() + 0.5 * std::log(conditional) +
         (prior.height_m ? std::log(prior.height_m->log_sigma) : 0.0);
}

// The landmark with its marginal covariance, including that of `up`: the landmark tilts with `up`,
// and its other parameters adapt so that it still fits the boxes.
FittedObject FittedAt(const MultiViewObservation& observation, const Landmark& landmark,
                      const Eigen::Matrix3d& up_covariance) {
  const ParameterJacobian d_parameters = LandmarkByParameters(observation, landmark);
  const LandmarkModel model = ModelOf(
      observation.height_is_free ? OutlineTerms(observation) : ViewTerms(observation, landmark),
      landmark);
  const Information information = PriorInformation(d_parameters.cols()) +
                                  d_parameters.transpose() * model.information * d_parameters;
  const Eigen::Matrix<double, Eigen::Dynamic, 3, 0, kMaxParameters, 3> mixed =
      d_parameters.transpose() * model.information.leftCols<3>();
  const Eigen::LDLT<Information> solver(information);
  Eigen::Matrix<double, kLandmarkDof, 3> d_turn = -d_parameters * solver.solve(mixed);
  d_turn.topRows<3>() += Eigen::Matrix3d::Identity();
  const Covariance9 covariance =
      d_parameters * solver.solve(ParameterJacobian(d_parameters).transpose()) +
      d_turn * up_covariance * d_turn.transpose();
  return {landmark, covariance,
          model.cost + LogNormalisation(*observation.prior) +
              0.5 * solver.vectorD().array().log().sum()};
}

// Landmark from one box: the best yaw of a sweep.
std::optional<Landmark> LandmarkOnPlane(const Sequence& sequence, const Detection& detection,
                                        const MultiViewObservation& all,
                                        const AssociateOptions& options) {
  const Frame& frame = sequence.FrameOf(detection);
  const Camera& camera = sequence.CameraOf(detection);
  // The plane and pose shared by all views: the detection's own plane may be unknown, or come from
  // a better pose.
  const UprightObservation observation = {
      camera,
      BoxEdges(camera, detection.box, detection.is_one_sided, options.box_sigma_fraction,
               all.prior->edge_bias),
      Transform(frame.world_from_camera.Inverse(), all.plane_in_world), *all.prior};
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
    const Detection& detection = sequence.detections[index];
    const auto start = LandmarkOnPlane(sequence, detection, observation, options);
    if (!start) continue;
    const auto solution = FitUpright(observation.plane_in_world, *start,
                                     ViewTerms(observation, *start), /*yaw_is_free=*/true);
    if (solution) return solution->landmark;
  }
  return std::nullopt;
}

// FitObject for one face that the object may rest on.
std::optional<FittedObject> FitOnFace(const Sequence& sequence, const std::vector<int>& detections,
                                      const std::optional<ShapePrior>& prior,
                                      const AssociateOptions& options,
                                      const std::variant<Plane, UpEstimate>& support_in_world) {
  const std::vector<int> used = SpreadOver(detections, static_cast<size_t>(options.max_views));
  const auto* up = std::get_if<UpEstimate>(&support_in_world);
  MultiViewObservation observation =
      MakeMultiViewObservation(sequence, used, prior, options.box_sigma_fraction);
  observation.height_is_free = up != nullptr;
  observation.size_is_known = true;
  if (up == nullptr) observation.plane_in_world = std::get<Plane>(support_in_world);
  WeighViews(options.view_correlation_deg * kRadPerDeg, &observation);
  std::optional<Landmark> landmark;
  if (up != nullptr) {
    const auto body =
        FitBodyAtFreeHeight(observation, up->up_in_world, options.yaw_grid_deg * kRadPerDeg);
    if (body) landmark = body->landmark;
    observation.plane_in_world = {up->up_in_world, 0.0};
  } else {
    landmark = LandmarkOnPlane(sequence, used, observation, options);
  }
  if (!landmark) return std::nullopt;
  const FittedObject fitted =
      FittedAt(observation, *landmark, up ? up->covariance : Eigen::Matrix3d::Zero());
  if (!fitted.covariance.allFinite() || !std::isfinite(fitted.cost)) return std::nullopt;
  return fitted;
}

}  // namespace

std::optional<FittedObject> FitObject(const Sequence& sequence, const std::vector<int>& detections,
                                      const ShapePrior& prior, const AssociateOptions& options,
                                      const std::variant<Plane, UpEstimate>& support_in_world) {
  const auto on_faces = OnPossibleFaces(prior);
  std::optional<FittedObject> best;
  for (const auto& on_face : on_faces) {
    const auto fit = FitOnFace(sequence, detections, on_face, options, support_in_world);
    if (fit && (!best || fit->cost < best->cost)) best = fit;
  }
  // All faces are equally probable.
  if (best) best->cost += std::log(static_cast<double>(on_faces.size()));
  return best;
}

}  // namespace soslam

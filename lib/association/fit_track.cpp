// SPDX-License-Identifier: BSD-3-Clause
#include "association/fit_track.h"

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "initialisation/fit_object.h"
#include "initialisation/upright.h"

namespace soslam {
namespace {

// The parameters of UprightVector, the last of which, the height, is free without a plane.
constexpr int kMaxParameters = 7;
using Information =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxParameters, kMaxParameters>;
using ParameterJacobian =
    Eigen::Matrix<double, kLandmarkDof, Eigen::Dynamic, 0, kLandmarkDof, kMaxParameters>;

// The landmark with its marginal covariance, including that of `up`: the landmark tilts with `up`,
// and its other parameters adapt so that it still fits the boxes.
FittedObject FittedAt(const ObjectEvidence& evidence, const Landmark& landmark,
                      const Eigen::Matrix3d& up_covariance) {
  const ParameterJacobian d_parameters = UprightGround(evidence.plane)
                                             .ParameterJacobian(landmark)
                                             .leftCols(evidence.height_is_free ? 7 : 6);
  const LandmarkModel model = ModelOf(CostsAt(evidence, landmark), landmark);
  // Weak prior that keeps the information regular, as standard deviations: yaw uniform over half a
  // turn, foot anywhere (m), log half axes 1.
  Eigen::Matrix<double, kMaxParameters, 1> sigmas;
  sigmas << std::numbers::pi / std::sqrt(12.0), 1e3, 1e3, 1.0, 1.0, 1.0, 1e3;
  const Information prior_information =
      sigmas.head(d_parameters.cols()).array().square().inverse().matrix().asDiagonal();
  const Information information =
      prior_information + d_parameters.transpose() * model.information * d_parameters;
  const Eigen::Matrix<double, Eigen::Dynamic, 3, 0, kMaxParameters, 3> mixed =
      d_parameters.transpose() * model.information.leftCols<3>();
  const Eigen::LDLT<Information> solver(information);
  Eigen::Matrix<double, kLandmarkDof, 3> d_turn = -d_parameters * solver.solve(mixed);
  d_turn.topRows<3>() += Eigen::Matrix3d::Identity();
  const Covariance9 covariance =
      d_parameters * solver.solve(ParameterJacobian(d_parameters).transpose()) +
      d_turn * up_covariance * d_turn.transpose();
  // Sum of the logarithms of the prior's standard deviations: its normalisation.
  const ShapePrior& prior = *evidence.prior;
  const double conditional = 1.0 - prior.log_correlation * prior.log_correlation;
  const double log_normalisation = prior.log_sigma.array().log().sum() +
                                   0.5 * std::log(conditional) +
                                   (prior.height_m ? std::log(prior.height_m->log_sigma) : 0.0);
  return {landmark, covariance,
          model.cost + log_normalisation + 0.5 * solver.vectorD().array().log().sum()};
}

}  // namespace

std::optional<FittedObject> FitTrack(const Sequence& sequence, const std::vector<int>& detections,
                                     const ShapePrior& prior, const AssociateOptions& options,
                                     const std::variant<Plane, UpEstimate>& support_in_world) {
  ObjectEvidence evidence =
      EvidenceInWorld(sequence, SpreadOver(detections, static_cast<size_t>(options.max_views)),
                      prior, options.upright);
  const auto* up = std::get_if<UpEstimate>(&support_in_world);
  evidence.height_is_free = up != nullptr;
  evidence.plane = up != nullptr ? Plane{up->up_in_world, 0.0} : std::get<Plane>(support_in_world);
  evidence.size_is_known = true;
  WeighViews(options.upright.ViewCorrelation(), &evidence);
  const auto on_faces = OnEachFace(evidence);
  std::optional<FittedObject> best;
  for (const ObjectEvidence& on_face : on_faces) {
    const auto starts = ProfileOverYaw(on_face, options.upright.YawStep()).Minima(1);
    const auto fits = FitObject(on_face, starts, {.max_hypotheses = 1});
    if (fits.empty()) continue;
    const FittedObject fit = FittedAt(on_face, fits.front().landmark,
                                      up != nullptr ? up->covariance : Eigen::Matrix3d::Zero());
    if (!fit.covariance.allFinite() || !std::isfinite(fit.cost)) continue;
    if (!best || fit.cost < best->cost) best = fit;
  }
  // All faces are equally probable.
  if (best) best->cost += std::log(static_cast<double>(on_faces.size()));
  return best;
}

}  // namespace soslam

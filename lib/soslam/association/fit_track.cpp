// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/association/fit_track.h"

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "soslam/geometry/iou.h"
#include "soslam/initialisation/fit_object.h"
#include "soslam/initialisation/upright.h"

namespace soslam {
namespace {

// Errors of about a tenth of log evidence are accepted; in the valley along the ray of a single box
// a step lowers the cost by much less than what is left.
constexpr FitTolerance kToleranceOfTracks = {.cost = 1e-5, .half_axes = 1e-3};
// The parameters of UprightVector, the last of which, the height, is free without a plane.
constexpr int kMaxParameters = 7;
using Information =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxParameters, kMaxParameters>;
using ParameterJacobian =
    Eigen::Matrix<double, kLandmarkDof, Eigen::Dynamic, 0, kLandmarkDof, kMaxParameters>;

// Information of a weak prior that keeps that of boxes regular, as standard deviations: yaw uniform
// over half a turn, foot anywhere (m), log half axes 1, height anywhere (m).
Information WeakInformation(Eigen::Index parameters) {
  Eigen::Matrix<double, kMaxParameters, 1> sigmas;
  sigmas << std::numbers::pi / std::sqrt(12.0), 1e3, 1e3, 1.0, 1.0, 1.0, 1e3;
  return sigmas.head(parameters).array().square().inverse().matrix().asDiagonal();
}

// The landmark with its marginal covariance, including that of `up`: the landmark tilts with `up`,
// and its other parameters adapt so that it still fits the boxes.
FittedObject FittedAt(const ObjectEvidence& evidence, const Landmark& landmark,
                      const Eigen::Matrix3d& up_covariance) {
  const ParameterJacobian d_parameters = UprightParametrisation(evidence.plane)
                                             .ParameterJacobian(landmark)
                                             .leftCols(evidence.height_is_free ? 7 : 6);
  const LandmarkModel model = LineariseCosts(CostsAt(evidence, landmark), landmark);
  const Information information = WeakInformation(d_parameters.cols()) +
                                  d_parameters.transpose() * model.information * d_parameters;
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
  const double log_normalisation =
      prior.log_sigma.array().log().sum() + 0.5 * std::log(conditional) +
      (evidence.HasSize() ? std::log(prior.Length()->length_m.log_sigma) : 0.0);
  double prior_cost = log_normalisation + 0.5 * solver.vectorD().array().log().sum();
  FittedObject fitted{landmark, covariance, model.cost + prior_cost};
  fitted.cost_of_misfit = model.cost;
  for (const auto& term : PriorTerms(evidence)) {
    Eigen::VectorXd residuals(term->NumResiduals());
    term->Evaluate(landmark, residuals, nullptr);
    prior_cost += 0.5 * residuals.squaredNorm();
  }
  fitted.prior_cost = prior_cost;
  return fitted;
}

// The best fit on any face that the object may rest on, all of which are equally probable.
std::optional<FittedObject> FitOnFaces(const ObjectEvidence& evidence,
                                       const Eigen::Matrix3d& up_covariance,
                                       const std::vector<Landmark>& all_starts,
                                       const AssociateOptions& options) {
  const auto on_faces = OnEachFace(evidence);
  std::optional<FittedObject> best;
  for (const ObjectEvidence& on_face : on_faces) {
    std::vector<Landmark> starts;
    for (const Landmark& start : all_starts) {
      if (start.rests_on != on_face.RestsOn()) continue;
      starts.push_back(start);
      starts.back().shape_exponents = on_face.Exponents();
    }
    if (starts.empty()) starts = ProfileOverYaw(on_face, options.upright.YawStep()).Minima(1);
    const auto fits = FitObject(on_face, starts, {.max_hypotheses = 1});
    if (fits.empty()) continue;
    const FittedObject fit = FittedAt(on_face, fits.front().landmark, up_covariance);
    if (!fit.covariance.allFinite() || !std::isfinite(fit.cost)) continue;
    if (!best || fit.cost < best->cost) best = fit;
  }
  const double cost_of_face = std::log(static_cast<double>(on_faces.size()));
  if (best) best->cost += cost_of_face;
  if (best) best->prior_cost += cost_of_face;
  return best;
}

}  // namespace

std::optional<FittedObject> FitTrack(const Sequence& sequence, const std::vector<int>& detections,
                                     const ShapePrior& prior, const AssociateOptions& options,
                                     const std::variant<Plane, UpEstimate>& support_in_world,
                                     const TrackFitOptions& how) {
  ObjectEvidence evidence =
      EvidenceInWorld(sequence, SpreadOver(detections, static_cast<size_t>(options.max_views)),
                      prior, options.upright);
  const auto* up = std::get_if<UpEstimate>(&support_in_world);
  evidence.height_is_free = up != nullptr;
  evidence.plane = up != nullptr ? Plane{up->up_in_world, 0.0} : std::get<Plane>(support_in_world);
  evidence.size_is_known = true;
  evidence.tolerance = kToleranceOfTracks;
  WeighViews(options.upright.ViewCorrelation(), &evidence);
  const Eigen::Matrix3d up_covariance = up != nullptr ? up->covariance : Eigen::Matrix3d::Zero();
  std::optional<FittedObject> best = FitOnFaces(evidence, up_covariance, how.starts, options);
  // Lower edges are left out only where the misfit of all boxes costs more than hiding the feet.
  double cost_of_hiding = -std::log(kHiddenFeet);
  for (const BoxView& view : evidence.views) {
    if (view.edges[3].is_one_sided) continue;
    // -log of the density of a lower edge whose foot may be hidden, anywhere within twice the box's
    // height, over that of one where it is expected.
    const double height_px = std::abs((view.edges[1].plane + view.edges[3].plane).z());
    const double sigma_px = view.edges[3].sigma_px;
    cost_of_hiding +=
        view.weight * std::log(2.0 * height_px /
                               (kHiddenFeetInView * std::sqrt(2.0 * std::numbers::pi) * sigma_px));
  }
  if (!best || !how.feet_may_be_hidden || best->cost_of_misfit <= cost_of_hiding) return best;
  for (BoxView& view : evidence.views) view.edges[3].is_one_sided = true;
  auto hidden = FitOnFaces(evidence, up_covariance, how.starts, options);
  if (!hidden) return best;
  hidden->cost += cost_of_hiding;
  hidden->prior_cost -= std::log(kHiddenFeet);
  hidden->feet_are_hidden = true;
  return hidden->cost < best->cost ? hidden : best;
}

double OverlapByBoxes(const Sequence& sequence, const std::vector<int>& detections,
                      const ShapePrior& prior, const AssociateOptions& options,
                      const FittedObject& object) {
  constexpr int kSamples = 500;
  const Landmark& landmark = object.landmark_in_world;
  ObjectEvidence evidence =
      EvidenceInWorld(sequence, SpreadOver(detections, static_cast<size_t>(options.max_views)),
                      prior, options.upright);
  evidence.prior.reset();
  evidence.plane = ComputeSupportPlane(landmark);
  WeighViews(options.upright.ViewCorrelation(), &evidence);
  for (BoxView& view : evidence.views) {
    if (object.feet_are_hidden) view.edges[3].is_one_sided = true;
    for (BoxEdge& edge : view.edges) {
      if (edge.is_one_sided) edge.sigma_px = std::numeric_limits<double>::infinity();
    }
  }
  const UprightParametrisation upright(evidence.plane);
  const ParameterJacobian d_parameters = upright.ParameterJacobian(landmark).leftCols<6>();
  const Information information =
      WeakInformation(6) + d_parameters.transpose() *
                               LineariseCosts(CostsAt(evidence, landmark), landmark).information *
                               d_parameters;
  const Eigen::LLT<Information> root(information);
  std::mt19937 random;
  std::normal_distribution<double> normal;
  double sum = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    Eigen::Matrix<double, 6, 1> draw;
    for (double& value : draw) value = normal(random);
    UprightVector parameters = upright.ComputeParameters(landmark);
    parameters.head<6>() += root.matrixU().solve(draw);
    sum += BoxIou(landmark,
                  upright.LandmarkAt(parameters, landmark.shape_exponents, landmark.rests_on));
  }
  return sum / kSamples;
}

}  // namespace soslam

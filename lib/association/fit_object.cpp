// SPDX-License-Identifier: BSD-3-Clause
#include "association/fit_object.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "constraints/tangency.h"
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
using ParameterJacobian =
    Eigen::Matrix<double, kLandmarkDof, Eigen::Dynamic, 0, kLandmarkDof, kMaxParameters>;

// Weak prior that keeps the information regular, as standard deviations: yaw uniform over half a
// turn, contact point anywhere (m), log half axes 1.
Information PriorInformation(Eigen::Index parameters) {
  Eigen::Matrix<double, kMaxParameters, 1> sigmas;
  sigmas << std::numbers::pi / std::sqrt(12.0), 1e3, 1e3, 1.0, 1.0, 1.0, 1e3;
  return sigmas.head(parameters).array().square().inverse().matrix().asDiagonal();
}

ParameterJacobian LandmarkByParameters(const MultiViewObservation& observation,
                                       const Landmark& landmark) {
  const Plane& plane = observation.plane_in_world;
  ParameterJacobian d_parameters =
      ParameterJacobian::Zero(kLandmarkDof, observation.height_is_free ? 7 : 6);
  d_parameters.leftCols<6>() = UprightGround(plane).ParameterJacobian(landmark);
  if (observation.height_is_free) d_parameters.block<3, 1>(3, 6) = plane.normal;
  return d_parameters;
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
  LandmarkModel model;
  for (const auto& term :
       observation.height_is_free ? OutlineTerms(observation) : ViewTerms(observation, landmark)) {
    term->AddTo(landmark, &model);
  }
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
      BoxEdges(camera, detection.box, detection.is_bound, options.box_sigma_fraction,
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
  MultiViewObservation observation = MakeMultiViewObservation(
      sequence, used, prior, options.box_sigma_fraction, options.view_correlation_deg * kRadPerDeg,
      /*height_is_free=*/up != nullptr, /*size_is_known=*/true,
      up == nullptr ? std::optional(std::get<Plane>(support_in_world)) : std::nullopt);
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

Drift::Drift(const std::vector<Frame>& frames, double rotation_sigma_rad,
             double translation_sigma_m)
    : rotation_variance_(rotation_sigma_rad * rotation_sigma_rad),
      translation_variance_(translation_sigma_m * translation_sigma_m),
      origin_(frames.empty() ? Eigen::Vector3d::Zero() : frames[0].world_from_camera.translation),
      position_sums_(1, Eigen::Vector3d::Zero()),
      product_sums_(1, Eigen::Matrix3d::Zero()) {
  for (const Frame& frame : frames) {
    const Eigen::Vector3d position = frame.world_from_camera.translation - origin_;
    position_sums_.push_back(position_sums_.back() + position);
    product_sums_.push_back(product_sums_.back() + position * position.transpose());
  }
}

Eigen::Matrix3d Drift::PointCovariance(int frame_index, int other_frame_index,
                                       const Eigen::Vector3d& point_in_world) const {
  const auto [first, last] = std::minmax(frame_index, other_frame_index);
  // The motions between the two frames end at the frames first + 1 to last.
  const auto begin = static_cast<size_t>(first) + 1;
  const auto end = static_cast<size_t>(last) + 1;
  const double motions = last - first;
  const Eigen::Vector3d point = point_in_world - origin_;
  const Eigen::Vector3d positions = position_sums_[end] - position_sums_[begin];
  const Eigen::Matrix3d levers = motions * point * point.transpose() -
                                 point * positions.transpose() - positions * point.transpose() +
                                 product_sums_[end] - product_sums_[begin];
  // The sum of |lever|^2 I - lever lever^T, which is -Skew(lever)^2.
  return translation_variance_ * motions * Eigen::Matrix3d::Identity() +
         rotation_variance_ * (levers.trace() * Eigen::Matrix3d::Identity() - levers);
}

namespace {

constexpr double kNoHuber = std::numeric_limits<double>::infinity();

// Gate in standard deviations: if more than one edge is farther off, an unseen object is always
// more likely. For images of 10^5 x 10^5 px CostOfAnyBox is 91, less than the square of this.
constexpr double kReach = 10.0;

// Residuals: the distance that the predicted outline extends beyond each box edge (px), with
// covariance.
struct Innovation {
  Eigen::Vector4d residuals;
  Eigen::Matrix4d covariance;
};

Eigen::Vector4d Outwards(const Box& box) { return {-box.x_min, -box.y_min, box.x_max, box.y_max}; }

Innovation InnovationOf(const Prediction& prediction, const Box& box,
                        const std::array<BoxEdge, 4>& edges) {
  Innovation innovation{Outwards(prediction.outline) - Outwards(box),
                        prediction.outline_covariance};
  for (size_t i = 0; i < edges.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (edges[i].is_bound && innovation.residuals[row] > 0.0) {
      innovation.residuals[row] = 0.0;
      innovation.covariance.row(row).setZero();
      innovation.covariance.col(row).setZero();
    }
    innovation.covariance(row, row) += edges[i].sigma_px * edges[i].sigma_px;
  }
  return innovation;
}

// Normal density of a subset of the edges (px).
struct NormalDensity {
  double cost;  // -2 log of the density
  double distance;
};

NormalDensity DensityOf(const Innovation& innovation, const std::vector<int>& edges) {
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 4, 4>;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 4, 1>;
  const Matrix covariance = innovation.covariance(edges, edges);
  const Vector residuals = innovation.residuals(edges);
  const Matrix lower = covariance.llt().matrixL();
  const double squared_distance =
      lower.triangularView<Eigen::Lower>().solve(residuals).squaredNorm();
  double cost = squared_distance;
  for (size_t i = 0; i < edges.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    cost += std::log(2.0 * std::numbers::pi * lower(row, row) * lower(row, row));
  }
  return {cost, std::sqrt(squared_distance)};
}

// Covariance (px^2) of the four outline edges that follows from the landmark's. The box equals the
// outline, so the Jacobian of BoxTerm is that of the outline's edges.
Eigen::Matrix4d OutlineCovariance(const Prediction& prediction, const Camera& camera,
                                  const FittedObject& object) {
  const auto edges = BoxEdges(camera, prediction.outline, {}, 1.0);
  const RobustViewTerm term(std::make_unique<BoxTerm>(edges, prediction.landmark_in_camera),
                            prediction.camera_from_world, kNoHuber, 1.0);
  Eigen::VectorXd residuals(4);
  LandmarkTerm::Jacobian d_landmark(4, kLandmarkDof);
  term.Evaluate(object.landmark_in_world, residuals, &d_landmark);
  for (size_t i = 0; i < edges.size(); ++i) {
    d_landmark.row(static_cast<Eigen::Index>(i)) *= edges[i].sigma_px;
  }
  return d_landmark * object.covariance * d_landmark.transpose();
}

bool IsOutOfReach(const Innovation& innovation) {
  const Eigen::Array4d reach = kReach * innovation.covariance.diagonal().array().sqrt();
  return (innovation.residuals.array().abs() > reach).count() > 1;
}

}  // namespace

BoxLikelihood::BoxLikelihood(const Sequence& sequence, const AssociateOptions& options)
    : sequence_(sequence),
      options_(options),
      drift_(sequence.frames, options.odometry_rotation_sigma_deg * kRadPerDeg,
             options.odometry_translation_sigma_m) {}

std::optional<Prediction> BoxLikelihood::Predict(const FittedObject& object, int known_frame_index,
                                                 int frame_index) const {
  const Frame& frame = sequence_.frames[frame_index];
  Prediction prediction;
  prediction.camera_from_world = frame.world_from_camera.Inverse();
  prediction.landmark_in_camera = Transform(prediction.camera_from_world, object.landmark_in_world);
  const Camera& camera = sequence_.CameraOf(frame);
  const auto outline = OutlineBox(camera, prediction.landmark_in_camera);
  if (!outline) return std::nullopt;
  prediction.outline = *outline;
  FittedObject drifted = object;
  drifted.covariance.block<3, 3>(3, 3) +=
      drift_.PointCovariance(known_frame_index, frame_index, object.landmark_in_world.Centre());
  prediction.outline_covariance = OutlineCovariance(prediction, camera, drifted);
  return prediction;
}

std::optional<BoxMatch> BoxLikelihood::Match(const Prediction& prediction,
                                             const Detection& detection,
                                             const EdgeBias& bias) const {
  const Box box = WithoutBias(detection.box, detection.is_bound, bias);
  const auto edges = BoxEdges(sequence_.CameraOf(detection), detection.box, detection.is_bound,
                              options_.box_sigma_fraction, bias);
  const Innovation innovation = InnovationOf(prediction, box, edges);
  if (IsOutOfReach(innovation)) return std::nullopt;
  const double p = options_.cut_edge_probability;
  BoxMatch best;
  best.overlap = BoxOverlap(prediction.outline, box);
  const NormalDensity whole = DensityOf(innovation, {0, 1, 2, 3});
  best.cost = whole.cost - 2.0 * std::log(1.0 - 4.0 * p);
  best.distance = whole.distance;
  for (int cut = 0; cut < 4 && p > 0.0; ++cut) {
    std::vector<int> others = {0, 1, 2, 3};
    std::erase(others, cut);
    const NormalDensity rest = DensityOf(innovation, others);
    const double extent_px =
        cut % 2 == 0 ? prediction.outline.Width() : prediction.outline.Height();
    const double cost = rest.cost - 2.0 * std::log(p / extent_px);
    if (cost < best.cost) best = {best.overlap, rest.distance, cut, cost};
  }
  return best;
}

double BoxLikelihood::CostOfAnyBox(const Detection& detection) const {
  const double width = sequence_.CameraOf(detection).width;
  const double height = sequence_.CameraOf(detection).height;
  // Left and right edge are uniform over the image with left < right; top and bottom likewise.
  return 2.0 * std::log(0.5 * width * width * 0.5 * height * height);
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/planes/standing_body.h"

#include <Eigen/Dense>
#include <array>
#include <limits>
#include <utility>

#include "soslam/base/levenberg_marquardt.h"
#include "soslam/base/parallel.h"
#include "soslam/initialisation/fit_object.h"
#include "soslam/initialisation/upright.h"
#include "soslam/planes/plane_heights.h"

namespace soslam {
namespace {

// Information of a prior of all parameters of a body, as a share of the largest, for those that are
// not observed (the yaw of a round body).
constexpr double kPriorShare = 1e-9;
constexpr size_t kAllMinima = std::numeric_limits<size_t>::max();

Rigid3d MakeRigidMotion(const Plane& plane, const Eigen::Vector3d& pivot,
                        const PlaneMotion& motion) {
  const Eigen::Quaterniond level = UprightRotation(plane.normal, 0.0);
  const Eigen::Quaterniond turn = ExpRotation(level * Eigen::Vector3d(motion.x(), motion.y(), 0.0));
  return {turn, pivot - turn * pivot + motion.z() * (turn * plane.normal)};
}

constexpr int kMaxIterations = 60;
constexpr double kNegligiblePlaneDecrease = 1e-9;

// Two turns, and the height of each plane.
Eigen::VectorXd NoMotion(const StandingBodies& standing) {
  return Eigen::VectorXd::Zero(static_cast<Eigen::Index>(standing.planes.size()) + 2);
}

// The cost of all bodies and of the cameras' up prior to second order in the planes' motions.
QuadraticModel<Eigen::Dynamic> LineariseCosts(const StandingBodies& standing,
                                              const Eigen::Vector3d& pivot) {
  const Eigen::VectorXd zero = NoMotion(standing);
  QuadraticModel<Eigen::Dynamic> sum{0.0, zero, Eigen::MatrixXd::Zero(zero.size(), zero.size())};
  const auto add = [&](const PlaneEvidence& evidence, int plane) {
    const std::array<Eigen::Index, 3> at = {0, 1, 2 + plane};
    sum.cost += evidence.cost;
    sum.gradient(at) += evidence.gradient;
    sum.information(at, at) += evidence.information;
  };
  add(ComputePlaneEvidence(standing.up_prior, standing.planes.front()), 0);
  for (size_t i = 0; i < standing.bodies.size(); ++i) {
    const StandingBody& body = standing.bodies[i];
    const double sigma = HeightSigma(body, standing.height_sigma_fraction);
    add(WithHeightNoise(ComputePlaneEvidence(body, pivot), sigma), standing.plane_of[i]);
  }
  for (size_t i = 0; i < standing.heights.size(); ++i) {
    const int plane = standing.plane_of_height[i];
    add(ComputePlaneEvidence(standing.heights[i], standing.planes[plane], pivot), plane);
  }
  return sum;
}

PlaneMotion MotionOfPlane(const Eigen::VectorXd& step, int plane) {
  return {step(0), step(1), step(2 + plane)};
}

// All planes moved with their bodies, which are then fitted again; none when a fit fails.
std::optional<StandingBodies> Stepped(const StandingBodies& standing, const Eigen::Vector3d& pivot,
                                      const Eigen::VectorXd& step, int threads) {
  StandingBodies stepped = standing;
  for (size_t i = 0; i < standing.planes.size(); ++i) {
    stepped.planes[i] =
        ApplyMotion(standing.planes[i], pivot, MotionOfPlane(step, static_cast<int>(i)));
  }
  std::vector<std::optional<StandingBody>> settled(standing.bodies.size());
  ParallelFor(standing.bodies.size(), threads, [&](size_t i) {
    const int plane = standing.plane_of[i];
    StandingBody body = standing.bodies[i];
    body.landmark =
        ApplyMotion(standing.planes[plane], pivot, MotionOfPlane(step, plane), body.landmark);
    body.evidence.plane = stepped.planes[plane];
    settled[i] = FitOnPlane(std::move(body));
  });
  for (size_t i = 0; i < settled.size(); ++i) {
    if (!settled[i]) return std::nullopt;
    stepped.bodies[i] = std::move(*settled[i]);
  }
  return stepped;
}

}  // namespace

Plane ApplyMotion(const Plane& plane, const Eigen::Vector3d& pivot, const PlaneMotion& motion) {
  return Transform(MakeRigidMotion(plane, pivot, motion), plane);
}

Landmark ApplyMotion(const Plane& plane, const Eigen::Vector3d& pivot, const PlaneMotion& motion,
                     const Landmark& landmark) {
  return Transform(MakeRigidMotion(plane, pivot, motion), landmark);
}

std::optional<StandingBody> FitOnPlane(StandingBody body) {
  const auto fitted = FitUpright(body.evidence.plane, body.landmark, OutlineCosts(body.evidence));
  if (!fitted) return std::nullopt;
  body.landmark = fitted->landmark;
  return body;
}

PlaneEvidence ComputePlaneEvidence(const StandingBody& body, const Eigen::Vector3d& pivot) {
  const Plane& plane = body.evidence.plane;
  const Eigen::Matrix3d level = UprightRotation(plane.normal, 0.0).toRotationMatrix();
  Eigen::Matrix<double, kLandmarkDof, 3> d_motion;  // at zero motion
  d_motion.setZero();
  d_motion.topLeftCorner<3, 2>() = level.leftCols<2>();
  d_motion.block<3, 2>(3, 0) = -Skew(body.landmark.Centre() - pivot) * level.leftCols<2>();
  d_motion.block<3, 1>(3, 2) = plane.normal;
  const Eigen::Matrix<double, kLandmarkDof, 6> d_upright =  // at a fixed height
      UprightParametrisation(plane).ParameterJacobian(body.landmark).leftCols<6>();
  const LandmarkCosts outlines = OutlineCosts(body.evidence);
  const LandmarkModel model = LineariseCosts(outlines, body.landmark);
  QuadraticModel<6> of_body = model.Chained(d_upright);
  of_body.information.diagonal().array() += kPriorShare * of_body.information.diagonal().maxCoeff();
  const Eigen::Matrix<double, 6, 3> mixed = d_upright.transpose() * model.information * d_motion;
  const Eigen::Matrix<double, 3, 6> follows = of_body.information.llt().solve(mixed).transpose();
  PlaneEvidence evidence;
  evidence.cost = model.cost + ConstantCost(outlines);
  evidence.gradient = d_motion.transpose() * model.gradient;
  evidence.information = d_motion.transpose() * model.information * d_motion;
  evidence.gradient -= follows * of_body.gradient;
  evidence.information -= follows * mixed;
  return evidence;
}

std::optional<StandingBody> FitBodyAtFreeHeight(ObjectEvidence evidence,
                                                const Eigen::Vector3d& normal_in_world,
                                                double step) {
  evidence.plane = {normal_in_world, 0.0};
  evidence.height_is_free = true;
  const auto fits = FitObject(evidence, ProfileOverYaw(evidence, step).Minima(kAllMinima),
                              {.max_hypotheses = kAllMinima});
  evidence.height_is_free = false;
  for (const ObjectFit& fit : fits) {
    evidence.plane.offset = ComputeSupportPlane(fit.landmark).offset;
    const StandingBody body{evidence, fit.landmark};
    if (ComputePlaneEvidence(body, fit.landmark.Centre()).information(2, 2) > 0.0) return body;
  }
  return std::nullopt;
}

PlaneEvidence ComputePlaneEvidence(const UpPrior& up_prior, const Plane& plane) {
  const Eigen::Matrix<double, 3, 2> d_turns = UpByTurns(plane.normal);
  const Eigen::Vector3d d_normal = up_prior.information * plane.normal;
  PlaneEvidence evidence;
  evidence.cost = 0.5 * plane.normal.dot(d_normal);
  evidence.gradient.head<2>() = d_turns.transpose() * d_normal;
  evidence.information.topLeftCorner<2, 2>() = d_turns.transpose() * up_prior.information * d_turns;
  return evidence;
}

PlaneEvidence ComputePlaneEvidence(const HeightPrior& prior, const Plane& plane,
                                   const Eigen::Vector3d& pivot) {
  const Eigen::Matrix3d level = UprightRotation(plane.normal, 0.0).toRotationMatrix();
  const Eigen::Vector3d arm = prior.point_in_world - pivot;
  // Rotations about the pivot raise the plane at the point.
  const Eigen::Vector3d d_motion(-level.col(1).dot(arm), level.col(0).dot(arm), -1.0);
  PlaneEvidence evidence;
  evidence.Add(plane.SignedDistance(prior.point_in_world) / prior.sigma_m,
               d_motion / prior.sigma_m);
  return evidence;
}

double HeightSigma(const StandingBody& body, double height_sigma_fraction) {
  return height_sigma_fraction * 2.0 * body.landmark.half_axes.z();
}

Eigen::Vector3d MeanBasePoint(const std::vector<StandingBody>& bodies) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const StandingBody& body : bodies) {
    sum += body.landmark.Centre() - body.landmark.half_axes.z() * body.evidence.plane.normal;
  }
  return sum / static_cast<double>(bodies.size());
}

std::optional<RefinedPlanes> RefinePlanes(StandingBodies* standing, int threads) {
  const Eigen::Vector3d pivot = MeanBasePoint(standing->bodies);
  const auto start = Stepped(*standing, pivot, NoMotion(*standing), threads);
  if (!start) return std::nullopt;
  *standing = *start;
  const auto linearise = [&](const StandingBodies& at) { return LineariseCosts(at, pivot); };
  const auto plus = [&](const StandingBodies& at, const Eigen::VectorXd& step) {
    return step.allFinite() ? Stepped(at, pivot, step, threads) : std::nullopt;
  };
  const auto model =
      MinimiseSquares(linearise, plus, {kMaxIterations, kNegligiblePlaneDecrease}, standing);
  return RefinedPlanes{model.cost, pivot, model.information.inverse()};
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "planes/standing_body.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "initialisation/upright.h"

namespace soslam {
namespace {

constexpr int kHeightSteps = 20;
constexpr double kSettledHeight = 1e-3;  // share of the body's size
// Eigenvalues below this share of the largest count as unobserved (the yaw of a round body).
constexpr double kMinInformationShare = 1e-9;

Rigid3d MotionOf(const Plane& plane, const Eigen::Vector3d& pivot, const PlaneMotion& motion) {
  const Eigen::Quaterniond level = UprightRotation(plane.normal, 0.0);
  const Eigen::Quaterniond turn = ExpRotation(level * Eigen::Vector3d(motion.x(), motion.y(), 0.0));
  return {turn, pivot - turn * pivot + motion.z() * (turn * plane.normal)};
}

// d (nine parameters of kLandmarkDof) / d motion, at zero motion.
Eigen::Matrix<double, kLandmarkDof, 3> ByMotion(const Plane& plane, const Eigen::Vector3d& pivot,
                                                const Landmark& landmark) {
  const Eigen::Matrix3d level = UprightRotation(plane.normal, 0.0).toRotationMatrix();
  Eigen::Matrix<double, kLandmarkDof, 3> by_motion;
  by_motion.setZero();
  by_motion.topLeftCorner<3, 2>() = level.leftCols<2>();
  by_motion.block<3, 2>(3, 0) = -Skew(landmark.Centre() - pivot) * level.leftCols<2>();
  by_motion.block<3, 1>(3, 2) = plane.normal;
  return by_motion;
}

// Pseudo-inverse: zero on unobserved directions.
Eigen::Matrix<double, 6, 6> InverseOfKnown(const Eigen::Matrix<double, 6, 6>& information) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> eigen(information);
  const double least = kMinInformationShare * eigen.eigenvalues()(5);
  const Eigen::Matrix<double, 6, 1> inverse = eigen.eigenvalues().unaryExpr(
      [least](double value) { return value > least ? 1.0 / value : 0.0; });
  return eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
}

StandingBody Raised(StandingBody body, double rise) {
  const Plane plane = body.observation.plane_in_world;
  const Eigen::Vector3d centre = body.landmark.Centre();
  const PlaneMotion motion(0.0, 0.0, rise);
  body.landmark = Moved(plane, centre, motion, body.landmark);
  body.observation.plane_in_world = Moved(plane, centre, motion);
  return body;
}

// A body raised by `rise`, `rise` / 2, `rise` / 4, ..., at the first that costs less than `cost`.
std::optional<StandingBody> BetterRaised(const StandingBody& body, double cost, double rise,
                                         double least_rise) {
  for (; std::abs(rise) >= least_rise; rise *= 0.5) {
    auto raised = FitOnPlane(Raised(body, rise));
    if (raised && TotalCost(OutlineTerms(raised->observation), raised->landmark) < cost) {
      return raised;
    }
  }
  return std::nullopt;
}

// The body at its optimal height near its own, all other parameters adapting.
std::optional<StandingBody> OptimiseHeight(const StandingBody& start) {
  auto body = FitOnPlane(start);
  for (int i = 0; body && i < kHeightSteps; ++i) {
    const PlaneEvidence evidence = EvidenceOf(*body, body->landmark.Centre());
    if (!(evidence.information(2, 2) > 0.0)) return std::nullopt;
    const double size = body->landmark.half_axes.maxCoeff();
    const double rise =
        std::clamp(-evidence.gradient(2) / evidence.information(2, 2), -0.5 * size, 0.5 * size);
    const auto better = BetterRaised(*body, evidence.cost, rise, kSettledHeight * size);
    if (!better) break;
    body = better;
  }
  return body;
}

}  // namespace

Plane Moved(const Plane& plane, const Eigen::Vector3d& pivot, const PlaneMotion& motion) {
  return Transform(MotionOf(plane, pivot, motion), plane);
}

Landmark Moved(const Plane& plane, const Eigen::Vector3d& pivot, const PlaneMotion& motion,
               const Landmark& landmark) {
  return Transform(MotionOf(plane, pivot, motion), landmark);
}

std::optional<StandingBody> FitOnPlane(StandingBody body) {
  const auto fitted = FitUpright(body.observation.plane_in_world, body.landmark,
                                 OutlineTerms(body.observation), /*yaw_is_free=*/true);
  if (!fitted) return std::nullopt;
  body.landmark = fitted->landmark;
  return body;
}

PlaneEvidence EvidenceOf(const StandingBody& body, const Eigen::Vector3d& pivot) {
  const Plane& plane = body.observation.plane_in_world;
  const auto by_motion = ByMotion(plane, pivot, body.landmark);
  const UprightJacobian by_upright = UprightGround(plane).ByParameters(body.landmark);
  LandmarkModel model;
  const LandmarkCosts outlines = OutlineTerms(body.observation);
  for (const auto& outline : outlines) outline->AddTo(body.landmark, &model);
  const QuadraticModel<6> of_body = model.Chained(by_upright);
  const Eigen::Matrix<double, 3, 6> mixed = by_motion.transpose() * model.information * by_upright;
  const Eigen::Matrix<double, 3, 6> follows = mixed * InverseOfKnown(of_body.information);
  PlaneEvidence evidence;
  evidence.cost = model.cost + ConstantCost(outlines);
  evidence.gradient = by_motion.transpose() * model.gradient;
  evidence.information = by_motion.transpose() * model.information * by_motion;
  evidence.gradient -= follows * of_body.gradient;
  evidence.information -= follows * mixed.transpose();
  return evidence;
}

std::optional<StandingBody> FitBodyAtFreeHeight(MultiViewObservation observation,
                                                const Eigen::Vector3d& normal_in_world,
                                                double step) {
  observation.plane_in_world = {normal_in_world, 0.0};
  observation.height_is_free = true;
  const auto optima = SweepViews(observation, step);
  observation.height_is_free = false;
  std::optional<StandingBody> best;
  double lowest = 0.0;
  for (const UprightSolution& optimum : optima) {
    observation.plane_in_world.offset = SupportPlaneOf(optimum.landmark).offset;
    const auto body = OptimiseHeight({observation, optimum.landmark});
    if (!body) continue;
    const double cost = EvidenceOf(*body, body->landmark.Centre()).cost;
    if (best && cost >= lowest) continue;
    best = body;
    lowest = cost;
  }
  return best;
}

}  // namespace soslam

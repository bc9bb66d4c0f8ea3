// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/initialisation/upright.h"

#include <algorithm>
#include <cmath>

#include "soslam/base/levenberg_marquardt.h"
#include "soslam/constraints/standing_on_plane.h"

namespace soslam {
namespace {

// With one box, whose minimum is a narrow valley along its ray, the last per cent of a free height
// takes many.
constexpr int kMaxIterations = 100;

}  // namespace

UprightParametrisation::UprightParametrisation(const Plane& plane)
    : rotation(UprightRotation(plane.normal, 0.0)),
      x(rotation * Eigen::Vector3d::UnitX()),
      y(plane.normal.cross(x)),
      normal(plane.normal),
      origin(-plane.offset * plane.normal) {}

Landmark UprightParametrisation::LandmarkAt(const UprightVector& parameters,
                                            const ShapeExponents& shape_exponents,
                                            RestingFace rests_on) const {
  Landmark landmark;
  landmark.half_axes = parameters.segment<3>(3).array().exp();
  landmark.shape_exponents = shape_exponents;
  landmark.rests_on = rests_on;
  const double half_yaw = 0.5 * parameters[0];
  const Eigen::Quaterniond turn(std::cos(half_yaw), 0.0, 0.0, std::sin(half_yaw));
  landmark.frame_from_object = {(rotation * turn).normalized(),
                                origin + parameters[1] * x + parameters[2] * y +
                                    (parameters[6] + landmark.half_axes.z()) * normal};
  return landmark;
}

UprightVector UprightParametrisation::ComputeParameters(const Landmark& landmark) const {
  const Eigen::Vector3d from_origin = landmark.Centre() - origin;
  UprightVector parameters;
  parameters << Yaw(normal, landmark.frame_from_object.rotation), from_origin.dot(x),
      from_origin.dot(y), landmark.half_axes.array().log().matrix(),
      from_origin.dot(normal) - landmark.half_axes.z();
  return parameters;
}

UprightJacobian UprightParametrisation::ParameterJacobian(const Landmark& landmark) const {
  UprightJacobian jacobian = UprightJacobian::Zero();
  jacobian.block<3, 1>(0, 0) = normal;
  jacobian.block<3, 1>(3, 1) = x;
  jacobian.block<3, 1>(3, 2) = y;
  jacobian.block<3, 1>(3, 5) = landmark.half_axes.z() * normal;
  jacobian.block<3, 3>(6, 3).setIdentity();
  jacobian.block<3, 1>(3, 6) = normal;
  return jacobian;
}

std::optional<UprightSolution> FitUpright(const Plane& plane, const Landmark& start,
                                          const LandmarkCosts& costs, const UprightFreedom& is_free,
                                          double negligible_decrease) {
  const UprightParametrisation upright(plane);
  const auto landmark_at = [&](const UprightVector& at) {
    return upright.LandmarkAt(at, start.shape_exponents, start.rests_on);
  };
  const auto evaluate = [&](const UprightVector& at) {
    const Landmark landmark = landmark_at(at);
    QuadraticModel<7> sum =
        LineariseCosts(costs, landmark).Chained(upright.ParameterJacobian(landmark));
    if (!is_free.yaw) sum.Hold(0);
    if (!is_free.height) sum.Hold(6);
    return sum;
  };
  UprightVector parameters = upright.ComputeParameters(start);
  if (!is_free.height) parameters[6] = 0.0;
  const double negligible = std::max(negligible_decrease, NegligibleDecrease(costs));
  const double cost = MinimiseSquares(evaluate, {kMaxIterations, negligible}, &parameters).cost;
  if (!std::isfinite(cost) || !parameters.allFinite()) return std::nullopt;
  return UprightSolution{landmark_at(parameters), cost + ConstantCost(costs)};
}

std::optional<UprightSolution> FitLeaning(const Plane& plane, const Landmark& upright,
                                          const LandmarkCosts& costs) {
  const auto linearise = [&](const Landmark& at) { return LineariseCosts(costs, at); };
  const auto plus = [](const Landmark& at, const LandmarkStep& step) {
    return std::optional(ApplyStep(at, step));
  };
  const double tilt = StandingSigmas().angle_rad;
  const Eigen::Vector3d x = tilt * (upright.frame_from_object.rotation * Eigen::Vector3d::UnitX());
  const Eigen::Vector3d y = tilt * (upright.frame_from_object.rotation * Eigen::Vector3d::UnitY());
  std::optional<UprightSolution> best;
  for (const Eigen::Vector3d& turn :
       {Eigen::Vector3d(0.0 * x), x, y, Eigen::Vector3d(-x), Eigen::Vector3d(-y)}) {
    // The body turned about a horizontal direction, its lowest point still on the plane.
    Landmark landmark = upright;
    landmark.frame_from_object.rotation =
        (ExpRotation(turn) * upright.frame_from_object.rotation).normalized();
    const double lowest = plane.offset - FindSupportPoint(landmark, -plane.normal).extent;
    landmark.frame_from_object.translation -= lowest * plane.normal;
    const LevenbergMarquardtOptions options{kMaxIterations, NegligibleDecrease(costs)};
    const double cost = MinimiseSquares(linearise, plus, options, &landmark).cost;
    if (!std::isfinite(cost) || !HasExtent(landmark)) continue;
    if (!best || cost < best->cost) best = UprightSolution{landmark, cost};
  }
  if (best) best->cost += ConstantCost(costs);
  return best;
}

}  // namespace soslam

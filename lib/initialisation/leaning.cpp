// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/leaning.h"

#include <cmath>

#include "base/levenberg_marquardt.h"

namespace soslam {
namespace {

// The body turned about a horizontal direction, its lowest point still on the plane.
Landmark Tilted(const Landmark& upright, const Plane& plane, const Eigen::Vector3d& turn) {
  Landmark tilted = upright;
  tilted.frame_from_object.rotation =
      (ExpRotation(turn) * upright.frame_from_object.rotation).normalized();
  const double lowest = plane.offset - FindSupportPoint(tilted, -plane.normal).extent;
  tilted.frame_from_object.translation -= lowest * plane.normal;
  return tilted;
}

}  // namespace

void LeaningTerm::Evaluate(const Landmark& landmark, Eigen::Ref<Eigen::VectorXd> residuals,
                           Jacobian* jacobian) const {
  const LeaningOnPlane leaning(landmark, plane_, LeaningSigmas());
  residuals = leaning.residuals;
  if (jacobian != nullptr) *jacobian = leaning.d_landmark;
}

std::optional<UprightSolution> FitLeaning(const Plane& plane, const Landmark& upright,
                                          const LandmarkCosts& costs) {
  const auto linearise = [&](const Landmark& at) {
    LandmarkModel sum;
    for (const auto& cost : costs) cost->AddTo(at, &sum);
    return sum;
  };
  const auto plus = [](const Landmark& at, const LandmarkStep& step) {
    return std::optional(Moved(at, step));
  };
  const double tilt = LeaningSigmas().angle_rad;
  const Eigen::Vector3d x = tilt * (upright.frame_from_object.rotation * Eigen::Vector3d::UnitX());
  const Eigen::Vector3d y = tilt * (upright.frame_from_object.rotation * Eigen::Vector3d::UnitY());
  std::optional<UprightSolution> best;
  for (const Eigen::Vector3d& turn :
       {Eigen::Vector3d(0.0 * x), x, y, Eigen::Vector3d(-x), Eigen::Vector3d(-y)}) {
    Landmark landmark = Tilted(upright, plane, turn);
    const LevenbergMarquardtOptions options{50, NegligibleDecrease(costs)};
    const double cost = MinimiseSquares(linearise, plus, options, &landmark).cost;
    if (!std::isfinite(cost) || !HasExtent(landmark)) continue;
    if (!best || cost < best->cost) best = UprightSolution{landmark, cost};
  }
  if (best) best->cost += ConstantCost(costs);
  return best;
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/axis_cost_term.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "constraints/tangent_space.h"
#include "geometry/landmark.h"

namespace soslam {

AxisCostTerm::AxisCostTerm(int landmark, const double* landmark_in_world,
                           const Plane& plane_in_world, double weight)
    : Term({landmark}),
      landmark_in_world_(landmark_in_world),
      normal_(plane_in_world.normal),
      weight_(weight) {}

// Yaw counts from the world's axis (WorldAxis).
double AxisCostTerm::AngleToAxis() const {
  return Yaw(normal_, Eigen::Quaterniond(landmark_in_world_));
}

double AxisCostTerm::Cost() const { return Linearise(Hessian::kFar, TermPlaces()); }

double AxisCostTerm::Linearise(Hessian hessian, const TermPlaces& places) const {
  const double angle = AngleToAxis();
  const double sine = std::sin(2.0 * angle);
  const double cosine = std::cos(2.0 * angle);
  const double cost = weight_ * sine * sine;
  if (!std::isfinite(cost)) return std::numeric_limits<double>::infinity();
  if (places.gradient[0] == nullptr) return cost;
  Eigen::Map<Eigen::Vector3d>(places.gradient[0]) += 4.0 * weight_ * sine * cosine * normal_;
  const double repelled = hessian == Hessian::kNear ? sine * sine : 0.0;
  Eigen::Map<Eigen::Matrix<double, kLandmarkDof, kLandmarkDof>>(places.hessian[0][0])
      .topLeftCorner<3, 3>() +=
      8.0 * weight_ * (cosine * cosine - repelled) * normal_ * normal_.transpose();
  return cost;
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/tangencies_of_four.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "constraints/parameters.h"

namespace soslam {
namespace {

// Symmetric matrix from its lower triangle.
template <typename Block>
Eigen::Matrix3d Symmetric(const Block& block) {
  return block.template selfadjointView<Eigen::Lower>();
}

}  // namespace

BodyInWorld::BodyInWorld(const double* landmark_in_world, double p)
    : world_from_object(Eigen::Quaterniond(landmark_in_world).toRotationMatrix()),
      centre(landmark_in_world + 4),
      half_axes(Eigen::Vector3d(landmark_in_world + kPoseSize).array().exp()),
      shape_exponent(p) {}

LandmarkDerivatives::LandmarkDerivatives(const LandmarkSums<double>& sums,
                                         const Eigen::Matrix3d& world_from_object)
    : cost(std::isfinite(sums.numbers[sums.kCost]) ? sums.numbers[sums.kCost]
                                                   : std::numeric_limits<double>::infinity()),
      gradient(&sums.numbers[sums.kGradient]) {
  const Eigen::Map<const Eigen::Matrix<double, 9, 3>> by_turn(&sums.numbers[sums.kHessianByTurn]);
  const Eigen::Map<const Eigen::Matrix<double, 6, 3>> by_centre(
      &sums.numbers[sums.kHessianByCentre]);
  const Eigen::Map<const Eigen::Matrix3d> by_axes(&sums.numbers[sums.kHessianByAxes]);
  const Eigen::Matrix3d& to_world = world_from_object;

  gradient.head<3>() = to_world * gradient.head<3>();
  hessian.topLeftCorner<3, 3>() = to_world * Symmetric(by_turn.topRows<3>()) * to_world.transpose();
  hessian.bottomLeftCorner<6, 3>() = by_turn.bottomRows<6>().lazyProduct(to_world.transpose());
  hessian.topRightCorner<3, 6>() = hessian.bottomLeftCorner<6, 3>().transpose();
  hessian.block<3, 3>(3, 3) = Symmetric(by_centre.topRows<3>());
  hessian.block<3, 3>(6, 3) = by_centre.bottomRows<3>();
  hessian.block<3, 3>(6, 6) = by_axes;
}

void LandmarkDerivatives::AddTo(double* to_gradient, double* to_hessian) const {
  Eigen::Map<Gradient>(to_gradient) += gradient;
  Eigen::Map<Square> square(to_hessian);
  square.leftCols<3>() += hessian.leftCols<3>();
  square.middleCols<3>(3) += hessian.middleCols<3>(3);
  square.block<3, 3>(6, 6) += hessian.block<3, 3>(6, 6);
}

}  // namespace soslam

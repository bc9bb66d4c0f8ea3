// SPDX-License-Identifier: BSD-3-Clause
#include "constraints/plane_prior.h"

#include <ceres/normal_prior.h>

#include <Eigen/Eigenvalues>

namespace soslam {

std::unique_ptr<ceres::CostFunction> PlaneNormalPrior(const Eigen::Matrix3d& information) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(information);
  return std::make_unique<ceres::NormalPrior>(
      eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() * eigen.eigenvectors().transpose(),
      Eigen::Vector3d::Zero());
}

bool PlaneHeightResidual::Evaluate(double const* const* blocks, double* residuals,
                                   double** jacobians) const {
  const Eigen::Vector3d d_normal = side_ / prior_.sigma_m * prior_.point_in_world;
  residuals[0] =
      d_normal.dot(Eigen::Map<const Eigen::Vector3d>(blocks[0])) + blocks[1][0] / prior_.sigma_m;
  if (jacobians == nullptr) return true;
  if (jacobians[0] != nullptr) Eigen::Map<Eigen::Vector3d>{jacobians[0]} = d_normal;
  if (jacobians[1] != nullptr) jacobians[1][0] = 1.0 / prior_.sigma_m;
  return true;
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/cost_function.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <vector>

#include "soslam/constraints/parameters.h"
#include "support/numeric_derivatives.h"

namespace soslam {

// The residuals at these blocks, which have to be defined there.
inline Eigen::VectorXd ResidualsAt(const ceres::CostFunction& residual,
                                   const std::vector<const double*>& blocks) {
  Eigen::VectorXd values =
      Eigen::VectorXd::Constant(residual.num_residuals(), std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(residual.Evaluate(blocks.data(), values.data(), nullptr));
  return values;
}

// Checks a residual's Jacobians, in the tangent spaces of its blocks (poses, landmarks, normals,
// and vectors of any other size), against fourth-order central differences, whose error here is
// about 1e-10 of the residual's scale. (Ceres' own checker perturbs quaternion coefficients, which
// leaves the manifold and loses half of the digits.) The last `curvature_rows` are not checked:
// their Jacobian is not the derivative of their residual.
inline void ExpectCorrectJacobians(const ceres::CostFunction& residual,
                                   const std::vector<const double*>& blocks,
                                   int curvature_rows = 0) {
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  constexpr double kStep = 1e-4;
  const int rows = residual.num_residuals();
  std::vector<Matrix> ambient;
  std::vector<double*> pointers;
  for (const int size : residual.parameter_block_sizes()) {
    ambient.push_back(Matrix::Constant(rows, size, std::numeric_limits<double>::quiet_NaN()));
  }
  for (Matrix& matrix : ambient) pointers.push_back(matrix.data());
  Eigen::VectorXd values(rows);
  ASSERT_TRUE(residual.Evaluate(blocks.data(), values.data(), pointers.data()));
  EXPECT_TRUE(values == ResidualsAt(residual, blocks))
      << "residuals differ with and without Jacobians";

  for (size_t block = 0; block < blocks.size(); ++block) {
    const int size = residual.parameter_block_sizes()[block];
    const std::unique_ptr<ceres::Manifold> manifold(
        size == kPoseSize       ? NewPoseManifold()
        : size == kLandmarkSize ? NewLandmarkManifold()
        : size == kNormalSize   ? NewNormalManifold()
                                : new ceres::EuclideanManifold<ceres::DYNAMIC>(size));
    Matrix plus_jacobian(size, manifold->TangentSize());
    manifold->PlusJacobian(blocks[block], plus_jacobian.data());
    const Matrix analytic = ambient[block].topRows(rows - curvature_rows) * plus_jacobian;
    for (int i = 0; i < manifold->TangentSize(); ++i) {
      const auto moved = [&](double step) {
        Eigen::VectorXd delta = Eigen::VectorXd::Zero(manifold->TangentSize());
        delta(i) = step;
        Eigen::VectorXd point(size);
        manifold->Plus(blocks[block], delta.data(), point.data());
        std::vector<const double*> at = blocks;
        at[block] = point.data();
        return Eigen::VectorXd(ResidualsAt(residual, at).head(rows - curvature_rows));
      };
      const Eigen::VectorXd numeric = DerivativeAtZero(moved, kStep);
      EXPECT_LT((analytic.col(i) - numeric).norm(), 1e-7 * (1.0 + numeric.norm()))
          << "block " << block << ", tangent " << i << ": analytic " << analytic.col(i).transpose()
          << ", numeric " << numeric.transpose();
    }
  }
}

}  // namespace soslam

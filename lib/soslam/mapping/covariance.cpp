// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/mapping/covariance.h"

#include <ceres/manifold.h>

#include "soslam/mapping/normal_equations.h"

namespace soslam {
namespace {

// A variable of which this share of its information is left when all others are unknown has a
// million times the standard deviation that it would have if they were known.
constexpr double kLeastIndependentShare = 1e-12;

}  // namespace

// Columns of unit length: units do not count when it is decided what is determined.
MarginalCovariances::MarginalCovariances(ceres::Problem* problem) : problem_(problem) {
  const std::vector<double*> blocks = VariableBlocks(*problem);
  if (blocks.empty()) return;
  int columns = 0;
  for (const double* block : blocks) {
    first_column_[block] = columns;
    columns += problem->ParameterBlockTangentSize(block);
  }
  Eigen::SparseMatrix<double> normal =
      MakeNormalEquations(blocks, CurvatureRows::kWithout, problem).matrix;
  if (normal.rows() == 0) return;
  column_norms_ = normal.diagonal().cwiseSqrt();
  if (!column_norms_.allFinite() || !(column_norms_.minCoeff() > 0.0)) return;
  const Eigen::VectorXd inverse = column_norms_.cwiseInverse();
  normal = inverse.asDiagonal() * normal * inverse.asDiagonal();
  factor_.compute(normal);
  are_determined_ = factor_.info() == Eigen::Success &&
                    factor_.matrixL().nestedExpression().diagonal().array().square().minCoeff() >
                        kLeastIndependentShare;
}

Eigen::MatrixXd MarginalCovariances::HalfInverse(const double* block) const {
  const auto first = first_column_.find(block);
  if (first == first_column_.end()) return Eigen::MatrixXd::Zero(column_norms_.size(), 0);
  const int size = problem_->ParameterBlockTangentSize(block);
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(column_norms_.size(), size);
  for (int i = 0; i < size; ++i) {
    const int column = first->second + i;
    columns(factor_.permutationP().indices()[column], i) = 1.0 / column_norms_[column];
  }
  factor_.matrixL().solveInPlace(columns);
  return columns;
}

Covariance9 MarginalCovariances::OfLandmark(const double* landmark) const {
  Eigen::Matrix<double, Eigen::Dynamic, 9> half = HalfInverse(landmark);
  half.leftCols<3>() *= 2.0;  // Ceres' rotation tangent is half the rotation vector
  return half.transpose() * half;
}

Eigen::Matrix4d MarginalCovariances::OfPlane(const double* normal, const double* offset) const {
  Eigen::Matrix<double, Eigen::Dynamic, 4> half = Eigen::MatrixXd::Zero(column_norms_.size(), 4);
  if (const Eigen::MatrixXd of_normal = HalfInverse(normal); of_normal.cols() > 0) {
    Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor> normal_by_tangent(3,
                                                                                of_normal.cols());
    problem_->GetManifold(normal)->PlusJacobian(normal, normal_by_tangent.data());
    half.leftCols<3>() = of_normal * normal_by_tangent.transpose();
  }
  if (const Eigen::MatrixXd of_offset = HalfInverse(offset); of_offset.cols() > 0) {
    half.col(3) = of_offset;
  }
  return half.transpose() * half;
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/problem.h>

#include <Eigen/SparseCholesky>
#include <unordered_map>
#include <vector>

#include "model/estimates.h"

namespace soslam {

// Marginal covariances of a problem's variables where they are: blocks of the inverse of the
// information J^T J (losses included), from one sparse Cholesky factor of it. They hold in so far
// as the residuals' sigmas do.
class MarginalCovariances {
 public:
  // Evaluates and factors. The problem has to outlive it.
  explicit MarginalCovariances(ceres::Problem* problem);

  // Whether the residuals determine all variables. If not, there are no covariances.
  bool AreDetermined() const { return are_determined_; }

  // Of a landmark block, over (rotation vector in the world frame, rad; centre, m; log half axes).
  Covariance9 OfLandmark(const double* landmark) const;

  // Of a plane's blocks, over (normal, offset): of rank 3, as the normal has unit length; zero for
  // what is held constant.
  Eigen::Matrix4d OfPlane(const double* normal, const double* offset) const;

 private:
  // Columns of the factor's inverse, n x (tangents of the block), such that X_a^T X_b is the
  // covariance of blocks a and b; without columns for a block that is held constant.
  Eigen::MatrixXd HalfInverse(const double* block) const;

  ceres::Problem* problem_;
  std::unordered_map<const double*, int> first_column_;  // of variable blocks, in the Jacobian
  Eigen::VectorXd column_norms_;                         // of the Jacobian
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factor_;
  bool are_determined_ = false;
};

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/problem.h>

#include <Eigen/SparseCholesky>
#include <map>

#include "soslam/model/estimates.h"

namespace soslam {

// Marginal covariances of parameter blocks at their present values: blocks of (J^T W J)^-1, by one
// sparse Cholesky factor. They are as right as the residuals' sigmas. (The digits of
// ceres::Covariance depend on the BLAS that is installed.)
class MarginalCovariances {
 public:
  // Linearises the problem, and factors its normal equations. It must outlive this object.
  explicit MarginalCovariances(ceres::Problem* problem);

  // Whether the residuals determine all blocks. If not, there are no covariances.
  bool AreDetermined() const { return are_determined_; }
  // Whether a block has a covariance: residuals depend on it, and it is not constant.
  bool Has(const double* block) const { return are_determined_ && first_column_.contains(block); }

  // Covariance of a landmark that has one over (rotation vector in the world frame, rad; centre, m;
  // log half axes).
  Covariance9 OfLandmark(const double* landmark) const;

  // Covariance of a plane over (normal, offset): its rank is 3, as the normal has unit length; zero
  // for constant blocks.
  Eigen::Matrix4d OfPlane(const double* normal, const double* offset) const;

 private:
  // L^-1 P times the columns of a block, so that X^T Y is the covariance of two blocks; no columns
  // for constant blocks.
  Eigen::MatrixXd HalfInverse(const double* block) const;

  ceres::Problem* problem_;
  std::map<const double*, int> first_column_;
  Eigen::VectorXd column_norms_;
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factor_;
  bool are_determined_ = false;
};

}  // namespace soslam

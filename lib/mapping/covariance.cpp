// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/covariance.h"

#include <cmath>

#include "mapping/block_cholesky.h"

namespace soslam {
namespace {

// A variable of which this share of its information is left when all others are unknown has a
// million times the standard deviation that it would have if they were known.
constexpr double kLeastIndependentShare = 1e-12;

}  // namespace

MarginalCovariances::MarginalCovariances(const BackEndVariables& variables, const Terms& terms)
    : variables_(variables) {
  NormalEquations equations(variables.all(), terms);
  for (size_t i = 0; i < variables.all().size(); ++i) {
    block_of_.push_back(equations.BlockOf(static_cast<int>(i)));
  }
  const SymmetricBlocks& information = equations.hessian();
  if (information.NumRows() == 0 ||
      !std::isfinite(equations.Linearise(terms, Hessian::kInformation))) {
    return;
  }
  BlockCholesky factor(information);
  if (factor.Factor(information, Eigen::VectorXd::Zero(information.NumRows())) &&
      factor.LeastIndependentShare(information) > kLeastIndependentShare) {
    inverse_ = factor.InverseOnPattern(information);
  }
}

Covariance9 MarginalCovariances::OfLandmark(size_t object_index) const {
  const int block = block_of_[static_cast<size_t>(variables_.Landmark(object_index))];
  return inverse_->At(block, block);
}

Eigen::Matrix4d MarginalCovariances::OfPlane(size_t plane_index) const {
  const int normal = variables_.Normal(plane_index);
  const int normal_block = block_of_[static_cast<size_t>(normal)];
  const int offset_block = block_of_[static_cast<size_t>(variables_.Offset(plane_index))];
  const Eigen::MatrixXd by_step = ByStep(VariableKind::kNormal, variables_.Values(normal));
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  if (normal_block >= 0) {
    covariance.topLeftCorner<3, 3>() =
        by_step * inverse_->At(normal_block, normal_block) * by_step.transpose();
  }
  if (offset_block >= 0) covariance(3, 3) = inverse_->At(offset_block, offset_block)(0, 0);
  if (normal_block >= 0 && offset_block >= 0) {
    covariance.topRightCorner<3, 1>() =
        by_step * inverse_->At(offset_block, normal_block).transpose();
    covariance.bottomLeftCorner<1, 3>() = covariance.topRightCorner<3, 1>().transpose();
  }
  return covariance;
}

}  // namespace soslam

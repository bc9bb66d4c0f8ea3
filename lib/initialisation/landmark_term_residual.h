// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/cost_function.h>

#include <memory>
#include <utility>

#include "constraints/parameters.h"
#include "initialisation/upright.h"

namespace soslam {

// A LandmarkTerm as a Ceres cost function. Residuals: those of the term. Block: landmark in the
// frame of the term.
class LandmarkTermResidual final : public ceres::CostFunction {
 public:
  explicit LandmarkTermResidual(std::unique_ptr<const LandmarkTerm> term) : term_(std::move(term)) {
    set_num_residuals(term_->NumResiduals());
    *mutable_parameter_block_sizes() = {kLandmarkSize};
  }

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    const bool with_jacobian = jacobians != nullptr && jacobians[0] != nullptr;
    LandmarkTerm::Jacobian by_landmark(num_residuals(), kLandmarkDof);
    term_->Evaluate(UnpackLandmark(blocks[0]),
                    Eigen::Map<Eigen::VectorXd>(residuals, num_residuals()),
                    with_jacobian ? &by_landmark : nullptr);
    if (with_jacobian) {
      WriteLandmarkJacobian<Eigen::Dynamic>(blocks[0], by_landmark, jacobians[0]);
    }
    return true;
  }

 private:
  std::unique_ptr<const LandmarkTerm> term_;
};

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/cost_function.h>

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <vector>

#include "constraints/tangent_space.h"
#include "mapping/huber.h"
#include "mapping/term.h"

namespace soslam {

// A residual block of lib/constraints, its residuals together under one Huber loss (none with an
// infinite delta). Not for several threads at once: it keeps its Jacobians' memory.
class CostFunctionTerm final : public Term {
 public:
  struct Block {
    int variable;
    VariableKind kind;
    const double* values;
  };

  // The blocks in the order of the function's.
  CostFunctionTerm(std::unique_ptr<const ceres::CostFunction> function,
                   const std::vector<Block>& blocks,
                   double huber_delta = std::numeric_limits<double>::infinity());

  int NumResiduals() const { return function_->num_residuals(); }

  double Cost() const override;
  double Linearise(Hessian hessian, const TermPlaces& places) const override;

 private:
  std::unique_ptr<const ceres::CostFunction> function_;
  std::vector<Block> blocks_;
  std::vector<const double*> values_;
  HuberLoss loss_;
  mutable Eigen::VectorXd residuals_;
  mutable std::vector<ByValues> by_values_;
  mutable std::vector<Eigen::MatrixXd> by_steps_;
};

}  // namespace soslam

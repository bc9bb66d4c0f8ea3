// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/cost_function.h>

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "constraints/huber.h"
#include "constraints/tangent_space.h"
#include "mapping/term.h"

namespace soslam {

// A residual block of any sizes, its residuals together under one Huber loss (none with an infinite
// delta): what ResidualTerm does, sizes known or not.
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
                   double huber_delta = std::numeric_limits<double>::infinity())
      : Term(Variables(blocks)),
        function_(std::move(function)),
        blocks_(blocks),
        loss_{huber_delta} {}

  double Cost() const override { return Linearise(Hessian::kInformation, {}); }

  // Along the residual vector r a loss curves less than across: J^T (w I - (w - k) r r^T / r^2) J,
  // w its weight, k its curvature.
  double Linearise(Hessian hessian, const TermPlaces& places) const override {
    constexpr double kUndefined = std::numeric_limits<double>::infinity();
    Eigen::VectorXd residuals(function_->num_residuals());
    std::vector<Rows> by_values;
    std::vector<const double*> values;
    std::vector<double*> jacobians;
    for (const Block& block : blocks_) {
      values.push_back(block.values);
      by_values.emplace_back(residuals.size(), NumValues(block.kind));
    }
    for (Rows& rows : by_values) jacobians.push_back(rows.data());
    if (!function_->Evaluate(values.data(), residuals.data(), jacobians.data())) return kUndefined;
    const double length = residuals.norm();
    const HuberLoss::Value loss = loss_(length);
    if (!std::isfinite(loss.cost)) return kUndefined;
    const Eigen::VectorXd along = length > 0.0 ? residuals / length : residuals;
    const double less_along = hessian == Hessian::kNear ? loss.weight - loss.curvature : 0.0;
    const auto by_steps = [&](size_t i) -> Eigen::MatrixXd {
      return by_values[i] * ByStep(blocks_[i].kind, blocks_[i].values);
    };
    for (size_t i = 0; i < blocks_.size(); ++i) {
      if (places.gradient[i] == nullptr) continue;
      const Eigen::MatrixXd by_own = by_steps(i);
      Eigen::Map<Eigen::VectorXd>(places.gradient[i], by_own.cols()) +=
          loss.weight * by_own.transpose() * residuals;
      for (size_t j = 0; j <= i; ++j) {
        if (places.gradient[j] == nullptr) continue;
        const Eigen::MatrixXd by_other = by_steps(j);
        Eigen::Map<Eigen::MatrixXd>(places.hessian[i][j], by_own.cols(), by_other.cols()) +=
            loss.weight * by_own.transpose() * by_other -
            less_along * (by_own.transpose() * along) * (along.transpose() * by_other);
      }
    }
    return loss.cost;
  }

 private:
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  static std::vector<int> Variables(const std::vector<Block>& blocks) {
    std::vector<int> variables;
    for (const Block& block : blocks) variables.push_back(block.variable);
    return variables;
  }

  std::unique_ptr<const ceres::CostFunction> function_;
  std::vector<Block> blocks_;
  HuberLoss loss_;
};

}  // namespace soslam

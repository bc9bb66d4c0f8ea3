// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/cost_function_term.h"

namespace soslam {
namespace {

constexpr double kUndefined = std::numeric_limits<double>::infinity();

std::vector<int> Variables(const std::vector<CostFunctionTerm::Block>& blocks) {
  std::vector<int> variables;
  for (const auto& block : blocks) variables.push_back(block.variable);
  return variables;
}

}  // namespace

CostFunctionTerm::CostFunctionTerm(std::unique_ptr<const ceres::CostFunction> function,
                                   const std::vector<Block>& blocks, double huber_delta)
    : Term(Variables(blocks)),
      function_(std::move(function)),
      blocks_(blocks),
      loss_{huber_delta},
      residuals_(function_->num_residuals()) {
  for (const Block& block : blocks) {
    values_.push_back(block.values);
    by_values_.emplace_back(residuals_.size(), NumValues(block.kind));
    by_steps_.emplace_back(residuals_.size(), NumTangents(block.kind));
  }
}

double CostFunctionTerm::Cost() const {
  if (!function_->Evaluate(values_.data(), residuals_.data(), nullptr)) return kUndefined;
  const double cost = loss_(residuals_.norm()).cost;
  return std::isfinite(cost) ? cost : kUndefined;
}

// Along the residual vector r a loss curves less than across: J^T (w I - (w - k) r r^T / r^2) J, w
// its weight, k its curvature.
double CostFunctionTerm::Linearise(Hessian hessian, const TermPlaces& places) const {
  std::array<double*, TermPlaces::kMaxVariables> jacobians{};
  for (size_t i = 0; i < blocks_.size(); ++i) {
    if (places.gradient[i] != nullptr) jacobians[i] = by_values_[i].data();
  }
  if (!function_->Evaluate(values_.data(), residuals_.data(), jacobians.data())) return kUndefined;
  const double length = residuals_.norm();
  const HuberLoss::Value loss = loss_(length);
  if (!std::isfinite(loss.cost)) return kUndefined;
  const double less_along = hessian == Hessian::kNear ? loss.weight - loss.curvature : 0.0;
  for (size_t i = 0; i < blocks_.size(); ++i) {
    if (places.gradient[i] == nullptr) continue;
    const int size = NumTangents(blocks_[i].kind);
    ChainToSteps(blocks_[i].kind, blocks_[i].values, by_values_[i], &by_steps_[i]);
    Eigen::Map<Eigen::VectorXd>(places.gradient[i], size).noalias() +=
        loss.weight * by_steps_[i].transpose() * residuals_;
    for (size_t j = 0; j <= i; ++j) {
      if (places.gradient[j] == nullptr) continue;
      Eigen::Map<Eigen::MatrixXd> block(places.hessian[i][j], size, NumTangents(blocks_[j].kind));
      block.noalias() += loss.weight * by_steps_[i].transpose().lazyProduct(by_steps_[j]);
      if (less_along > 0.0) {
        block.noalias() -= less_along / (length * length) *
                           (by_steps_[i].transpose() * residuals_) *
                           (residuals_.transpose() * by_steps_[j]);
      }
    }
  }
  return loss.cost;
}

}  // namespace soslam

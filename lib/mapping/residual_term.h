// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/sized_cost_function.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "constraints/huber.h"
#include "constraints/tangent_space.h"
#include "mapping/term.h"

namespace soslam {

// A residual block of lib/constraints, its residuals together under one Huber loss (none with an
// infinite delta). All sizes are known when it is compiled. Variables: those of the residual's
// blocks, of these kinds and in this order.
template <typename Residual, VariableKind... kKinds>
class ResidualTerm final : public Term {
 public:
  static constexpr size_t kBlocks = sizeof...(kKinds);
  struct Block {
    int variable;
    const double* values;
  };

  // `arguments` are the residual's.
  template <typename... Arguments>
  ResidualTerm(const std::array<Block, kBlocks>& blocks, double huber_delta,
               Arguments&&... arguments)
      : Term(Variables(blocks)),
        residual_(std::forward<Arguments>(arguments)...),
        loss_{huber_delta} {
    for (size_t i = 0; i < kBlocks; ++i) values_[i] = blocks[i].values;
  }

  double Cost() const override {
    Residuals residuals;
    if (!residual_.Evaluate(values_.data(), residuals.data(), nullptr)) return kUndefined;
    const double cost = loss_(residuals.norm()).cost;
    return std::isfinite(cost) ? cost : kUndefined;
  }

  double Linearise(Hessian hessian, const TermPlaces& places) const override {
    return Linearise(hessian, places, std::make_index_sequence<kBlocks>());
  }

 private:
  static constexpr double kUndefined = std::numeric_limits<double>::infinity();

  template <int kCount, int... kSizes>
  static std::integral_constant<int, kCount> CountOf(
      const ceres::SizedCostFunction<kCount, kSizes...>*);
  static constexpr int kResiduals = decltype(CountOf(static_cast<const Residual*>(nullptr)))::value;
  using Residuals = Eigen::Matrix<double, kResiduals, 1>;
  template <VariableKind kKind>
  using ByValues = JacobianRows<kResiduals, NumValues(kKind)>;
  template <VariableKind kKind>
  using BySteps = Eigen::Matrix<double, kResiduals, NumTangents(kKind)>;

  static std::vector<int> Variables(const std::array<Block, kBlocks>& blocks) {
    std::vector<int> variables;
    for (const Block& block : blocks) variables.push_back(block.variable);
    return variables;
  }

  // Along the residual vector r a loss curves less than across: J^T (w I - (w - k) r r^T / r^2) J,
  // w its weight, k its curvature.
  struct Weights {
    Residuals gradient;  // w r
    double across;       // w
    // (w - k) / r^2: 0 where the loss's curvature does not count, NaN where r is 0.
    double less_along;
    const Residuals& residuals;
  };

  template <size_t... kIndices>
  double Linearise(Hessian hessian, const TermPlaces& places,
                   std::index_sequence<kIndices...>) const {
    Residuals residuals;
    std::tuple<ByValues<kKinds>...> by_values;
    std::array<double*, kBlocks> jacobians = {
        places.gradient[kIndices] ? std::get<kIndices>(by_values).data() : nullptr...};
    if (!residual_.Evaluate(values_.data(), residuals.data(), jacobians.data())) return kUndefined;
    const double length = residuals.norm();
    const HuberLoss::Value loss = loss_(length);
    if (!std::isfinite(loss.cost)) return kUndefined;
    const std::tuple<BySteps<kKinds>...> by_steps = {
        places.gradient[kIndices]
            ? ChainedToSteps<kKinds>(values_[kIndices], std::get<kIndices>(by_values))
            : BySteps<kKinds>::Zero()...};
    const Weights weights = {
        loss.weight * residuals, loss.weight,
        hessian == Hessian::kNear ? (loss.weight - loss.curvature) / (length * length) : 0.0,
        residuals};
    (Add<kIndices>(by_steps, weights, places), ...);
    return loss.cost;
  }

  template <size_t kIndex>
  void Add(const std::tuple<BySteps<kKinds>...>& by_steps, const Weights& weights,
           const TermPlaces& places) const {
    if (places.gradient[kIndex] == nullptr) return;
    const auto& by_own = std::get<kIndex>(by_steps);
    constexpr int kSize = std::remove_cvref_t<decltype(by_own)>::ColsAtCompileTime;
    Eigen::Map<Eigen::Matrix<double, kSize, 1>>(places.gradient[kIndex]) +=
        by_own.transpose().lazyProduct(weights.gradient);
    Eigen::Matrix<double, kSize, kResiduals> weighted = weights.across * by_own.transpose();
    if (weights.less_along > 0.0) {
      weighted -= weights.less_along * by_own.transpose().lazyProduct(weights.residuals) *
                  weights.residuals.transpose();
    }
    const auto add = [&]<size_t kOther>(std::integral_constant<size_t, kOther>) {
      if (places.gradient[kOther] == nullptr) return;
      const auto& by_other = std::get<kOther>(by_steps);
      constexpr int kOtherSize = std::remove_cvref_t<decltype(by_other)>::ColsAtCompileTime;
      Eigen::Map<Eigen::Matrix<double, kSize, kOtherSize>>(places.hessian[kIndex][kOther]) +=
          weighted.lazyProduct(by_other);
    };
    [&]<size_t... kOthers>(std::index_sequence<kOthers...>) {
      (add(std::integral_constant<size_t, kOthers>()), ...);
    }
    (std::make_index_sequence<kIndex + 1>());
  }

  Residual residual_;
  std::array<const double*, kBlocks> values_;
  HuberLoss loss_;
};

}  // namespace soslam

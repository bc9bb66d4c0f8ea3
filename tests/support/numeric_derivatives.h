// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <type_traits>

namespace soslam {

// The derivative of a function of one number at 0, by central differences of fourth order.
template <typename Function>
std::invoke_result_t<Function, double> DerivativeAtZero(const Function& function, double step) {
  return (8.0 * (function(step) - function(-step)) -
          (function(2.0 * step) - function(-2.0 * step))) /
         (12.0 * step);
}

// The derivatives of a function of three numbers by central differences: of a number as a vector,
// of a vector as the columns of a matrix.
template <typename Function>
auto NumericDerivatives(const Function& function, const Eigen::Vector3d& at) {
  using Value = std::invoke_result_t<Function, Eigen::Vector3d>;
  const auto along = [&](int axis) -> Value {
    constexpr double kStep = 1e-6;
    const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
    return (function(at + step) - function(at - step)) / (2.0 * kStep);
  };
  if constexpr (std::is_same_v<Value, double>) {
    return Eigen::Vector3d(along(0), along(1), along(2));
  } else {
    return (Eigen::Matrix3d() << along(0), along(1), along(2)).finished();
  }
}

}  // namespace soslam

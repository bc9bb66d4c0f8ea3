// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <optional>
#include <utility>

namespace soslam {

// Convergence tolerance, relative to 1 + cost: steps that lower the cost by less are not worth
// taking.
inline constexpr double kNegligibleDecrease = 1e-11;

struct LevenbergMarquardtOptions {
  int max_iterations = 50;
  double negligible_decrease = kNegligibleDecrease;
};

// Least squares over a few unknowns, by Levenberg-Marquardt with Nielsen's damping (Madsen,
// Nielsen, Tingleff: Methods for non-linear least squares problems, 2004, section 3.2). The damping
// multiplies the diagonal of the information, or 1e-6 for unknowns with almost no influence.
//
// `linearise(state)` returns cost, gradient and information (see QuadraticModel) about a state;
// `plus(state, step)` the state after a step, none if there is none. Ends if the predicted decrease
// is negligible, after max_iterations, or if no step lowers the cost. Returns the QuadraticModel at
// the final state: its cost is not finite if it is not at the initial one.
template <typename State, typename Linearise, typename Plus>
auto MinimiseSquares(const Linearise& linearise, const Plus& plus,
                     const LevenbergMarquardtOptions& options, State* state) {
  constexpr double kMinDiagonal = 1e-6;
  constexpr double kMaxDamping = 1e16;
  auto at = linearise(*state);
  using Vector = decltype(at.gradient);
  using Matrix = decltype(at.information);
  double damping = 1e-4;
  double damping_factor = 2.0;  // of a failed step; doubles with each
  for (int i = 0; i < options.max_iterations && damping < kMaxDamping; ++i) {
    const Vector weights = damping * at.information.diagonal().cwiseMax(kMinDiagonal);
    Matrix damped = at.information;
    damped.diagonal() += weights;
    const Eigen::LLT<Matrix> factor(damped);
    double gain_ratio = 0.0;
    if (factor.info() == Eigen::Success) {
      const Vector step = -factor.solve(at.gradient);
      const double decrease = 0.5 * step.dot(weights.cwiseProduct(step) - at.gradient);
      if (!(decrease > options.negligible_decrease * (1.0 + at.cost))) break;
      if (std::optional<State> moved = plus(*state, step)) {
        auto there = linearise(*moved);
        gain_ratio = (at.cost - there.cost) / decrease;
        if (gain_ratio > 0.0) {
          *state = std::move(*moved);
          at = there;
        }
      }
    }
    if (gain_ratio > 0.0) {
      const double centred = 2.0 * gain_ratio - 1.0;  // Nielsen's rule (1999)
      damping *= std::max(1.0 / 3.0, 1.0 - centred * centred * centred);
      damping_factor = 2.0;
    } else {
      damping *= damping_factor;
      damping_factor *= 2.0;
    }
  }
  return at;
}

// MinimiseSquares where a state and a step are vectors that are added.
template <typename Vector, typename Linearise>
auto MinimiseSquares(const Linearise& linearise, const LevenbergMarquardtOptions& options,
                     Vector* state) {
  const auto plus = [](const Vector& at, const Vector& step) {
    return std::optional<Vector>(at + step);
  };
  return MinimiseSquares(linearise, plus, options, state);
}

}  // namespace soslam

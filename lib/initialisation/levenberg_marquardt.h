// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <optional>

#include "initialisation/quadratic_model.h"

namespace soslam {

// Of 1 + cost: steps that lower it by less are not worth taking.
inline constexpr double kNegligibleDecrease = 1e-11;
// Where derivatives jump, as those of an image do from pixel to pixel, steps go to and fro at the
// end, each shorter than the one before, and take most of the time.
inline constexpr double kNegligibleDecreaseAtKinks = 1e-8;

// The x of A x = b, A positive definite; none where it is seen not to be. Of three unknowns by
// cofactors, which need not wait for each other's square roots and quotients.
template <int kSize>
std::optional<Eigen::Matrix<double, kSize, 1>> SolvePositiveDefinite(
    const Eigen::Matrix<double, kSize, kSize>& a, const Eigen::Matrix<double, kSize, 1>& b) {
  if constexpr (kSize == 3) {
    return a.inverse() * b;
  } else {
    const Eigen::LLT<Eigen::Matrix<double, kSize, kSize>> factor(a);
    if (factor.info() != Eigen::Success) return std::nullopt;
    return factor.solve(b);
  }
}

// Levenberg-Marquardt with Nielsen's damping (Madsen, Nielsen, Tingleff: Methods for non-linear
// least squares problems, 2004, section 3.2). `evaluate` makes the model at parameters.
// Ends where the next step is expected to lower the cost by a negligible share of it, after
// `max_iterations`, or where no step lowers it. Parameters that nothing depends on stay as they
// are. Returns the cost at the parameters that it leaves: not finite when it was not at the start.
template <int kSize, typename Evaluate>
double MinimiseSquares(Evaluate evaluate, int max_iterations,
                       Eigen::Matrix<double, kSize, 1>* parameters,
                       double negligible_decrease = kNegligibleDecrease) {
  constexpr double kMinDiagonal = 1e-6;
  constexpr double kMaxDamping = 1e16;
  QuadraticModel<kSize> at = evaluate(*parameters);
  double damping = 1e-4;
  double growth = 2.0;
  for (int i = 0; i < max_iterations && damping < kMaxDamping; ++i) {
    const Eigen::Matrix<double, kSize, 1> weights =
        damping * at.information.diagonal().cwiseMax(kMinDiagonal);
    typename QuadraticModel<kSize>::Matrix damped = at.information;
    damped.diagonal() += weights;
    const auto to_minimum = SolvePositiveDefinite<kSize>(damped, at.gradient);
    if (!to_minimum) {
      damping *= growth;
      growth *= 2.0;
      continue;
    }
    const Eigen::Matrix<double, kSize, 1> step = -*to_minimum;
    // Of the undamped cost to second order.
    const double decrease = 0.5 * step.dot(weights.cwiseProduct(step) - at.gradient);
    if (!(decrease > negligible_decrease * (1.0 + at.cost))) break;
    const Eigen::Matrix<double, kSize, 1> moved = *parameters + step;
    const QuadraticModel<kSize> there = evaluate(moved);
    const double gain = (at.cost - there.cost) / decrease;
    if (gain > 0.0) {
      *parameters = moved;
      at = there;
      const double surprise = 2.0 * gain - 1.0;
      damping *= std::max(1.0 / 3.0, 1.0 - surprise * surprise * surprise);
      growth = 2.0;
    } else {
      damping *= growth;
      growth *= 2.0;
    }
  }
  return at.cost;
}

}  // namespace soslam

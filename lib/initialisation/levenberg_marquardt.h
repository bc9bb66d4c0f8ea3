// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "initialisation/quadratic_model.h"

namespace soslam {

// Convergence tolerance, relative to 1 + cost: steps that lower the cost by less are not worth
// taking.
inline constexpr double kNegligibleDecrease = 1e-11;
// The same where derivatives jump, as those of an image do from pixel to pixel: near the minimum
// the steps oscillate with decreasing length, and would take most of the time.
inline constexpr double kNegligibleDecreaseAtKinks = 1e-8;

namespace levenberg_marquardt {

// The damping multiplies the diagonal of the information, or kMinDiagonal for parameters with
// almost no influence. It grows by a factor that doubles with each failed step, and falls with
// successful steps.
inline constexpr double kFirstDamping = 1e-4;
inline constexpr double kMaxDamping = 1e16;
inline constexpr double kMinDiagonal = 1e-6;
inline constexpr double kGrowth = 2.0;
inline constexpr double kLeastFall = 1.0 / 3.0;

}  // namespace levenberg_marquardt

// Solves A x = -b by A = L D L^T, which needs no square roots and takes half the time of Eigen::LLT
// at size 6. Reads the lower triangle of A. Returns false if A is not positive definite.
template <int kSize>
bool SolveForNegative(Eigen::Matrix<double, kSize, kSize> a,
                      const Eigen::Matrix<double, kSize, 1>& b,
                      Eigen::Matrix<double, kSize, 1>* x) {
  Eigen::Matrix<double, kSize, 1>& solution = *x;
  Eigen::Matrix<double, kSize, 1> inverse_d;
  solution = -b;
  for (int j = 0; j < kSize; ++j) {
    if (!(a(j, j) > 0.0)) return false;
    inverse_d[j] = 1.0 / a(j, j);
    // Updating whole columns takes no longer than updating the part below the diagonal.
    for (int k = j + 1; k < kSize; ++k) a.col(k) -= a(k, j) * inverse_d[j] * a.col(j);
    const double share = solution[j] * inverse_d[j];
    for (int i = j + 1; i < kSize; ++i) solution[i] -= share * a(i, j);
  }
  for (int j = kSize - 1; j >= 0; --j) {
    for (int i = j + 1; i < kSize; ++i) solution[j] -= a(i, j) * solution[i];
    solution[j] *= inverse_d[j];
  }
  return true;
}

// Levenberg-Marquardt with Nielsen's damping (Madsen, Nielsen, Tingleff: Methods for non-linear
// least squares problems, 2004, section 3.2). `evaluate` returns the QuadraticModel at given
// parameters. Ends if the predicted decrease, relative to 1 + cost, is negligible, after
// `max_iterations`, or if no step lowers the cost. Parameters without influence are not changed.
// Returns the cost at the final parameters: not finite if it is not finite at the start.
template <int kSize, typename Evaluate>
double MinimiseSquares(Evaluate evaluate, int max_iterations,
                       Eigen::Matrix<double, kSize, 1>* parameters,
                       double negligible_decrease = kNegligibleDecrease) {
  using namespace levenberg_marquardt;
  QuadraticModel<kSize> at = evaluate(*parameters);
  double damping = kFirstDamping;
  double growth = kGrowth;
  for (int i = 0; i < max_iterations && damping < kMaxDamping; ++i) {
    const Eigen::Matrix<double, kSize, 1> weights =
        damping * at.information.diagonal().cwiseMax(kMinDiagonal);
    typename QuadraticModel<kSize>::Matrix damped = at.information;
    damped.diagonal() += weights;
    Eigen::Matrix<double, kSize, 1> step;
    if (!SolveForNegative(damped, at.gradient, &step)) {
      damping *= growth;
      growth *= 2.0;
      continue;
    }
    // Predicted decrease of the undamped quadratic model.
    const double decrease = 0.5 * step.dot(weights.cwiseProduct(step) - at.gradient);
    if (!(decrease > negligible_decrease * (1.0 + at.cost))) break;
    const Eigen::Matrix<double, kSize, 1> moved = *parameters + step;
    const QuadraticModel<kSize> there = evaluate(moved);
    const double gain = (at.cost - there.cost) / decrease;
    if (gain > 0.0) {
      *parameters = moved;
      at = there;
      const double surprise = 2.0 * gain - 1.0;
      damping *= std::max(kLeastFall, 1.0 - surprise * surprise * surprise);
      growth = kGrowth;
    } else {
      damping *= growth;
      growth *= 2.0;
    }
  }
  return at.cost;
}

}  // namespace soslam

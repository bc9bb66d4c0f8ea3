// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace soslam {

// The Huber loss of a residual of length r: r^2 / 2 up to delta, and linear from there.
struct HuberLoss {
  double delta;

  struct Value {
    double cost;
    double weight;  // d cost / d (r^2 / 2)
    // What the weight is along the residual, d^2 cost / dr^2: 0 beyond delta. There it is rounded
    // up to a fraction of the weight, so that what only has residuals beyond delta is determined.
    double curvature;
  };

  Value operator()(double length) const {
    if (!(length > delta)) return {0.5 * length * length, 1.0, 1.0};
    const double weight = delta / length;
    return {delta * (length - 0.5 * delta), weight, kLeastCurvature * weight};
  }

  static constexpr double kLeastCurvature = 0.01;
};

}  // namespace soslam

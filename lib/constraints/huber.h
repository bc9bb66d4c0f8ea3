// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/wide_loops.h"

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

  // Values for four residuals (SIMD).
  struct FourValues {
    Four cost, weight, curvature;
  };
  SOSLAM_FORCE_INLINE FourValues operator()(const Four& length) const {
    const FourMask is_beyond = length > delta;
    FourValues values;
    values.weight = is_beyond ? delta / length : Four{} + 1.0;
    values.cost = is_beyond ? delta * (length - 0.5 * delta) : 0.5 * length * length;
    values.curvature = is_beyond ? kLeastCurvature * values.weight : values.weight;
    return values;
  }

  static constexpr double kLeastCurvature = 1e-3;
};

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "base/wide_loops.h"
#include "geometry/support_function.h"

namespace soslam {

// h = || u ||_p and dh / d log u, of four u at once; u >= 0, 1 <= p <= 2. Not finite for u = 0
// where p is neither 1 nor 2.
SOSLAM_IN_WIDE_LOOPS void NormByLogarithms(double p, const ThreeFours& u, Four* h,
                                           ThreeFours* by_log_u) {
  if (p == kCuboidExponent) {
    *h = u[0] + u[1] + u[2];
    *by_log_u = u;
    return;
  }
  if (p == kEllipsoidExponent) {
    const Four squares = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
    for (size_t k = 0; k < 4; ++k) (*h)[k] = std::sqrt(squares[k]);
    const Four inverse = 1.0 / (*h > 0.0 ? *h : Four{} + 1.0);
    for (size_t i = 0; i < 3; ++i) (*by_log_u)[i] = u[i] * u[i] * inverse;
    return;
  }
  for (size_t k = 0; k < 4; ++k) {
    const Eigen::Array3d u_of_one(u[0][k], u[1][k], u[2][k]);
    double norm = 0.0;
    const Eigen::Array3d by_u = NormByComponents(u_of_one, p, &norm);
    (*h)[k] = norm;
    for (size_t i = 0; i < 3; ++i) (*by_log_u)[i][k] = by_u[i] * u_of_one[i];
  }
}

}  // namespace soslam

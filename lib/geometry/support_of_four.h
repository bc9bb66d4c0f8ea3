// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "base/wide_loops.h"
#include "geometry/support_function.h"

namespace soslam {

// h = || u ||_p and dh / d log u for four u at once; 1 <= p <= 2, u >= 0 or, for p = 2, of any
// sign.
SOSLAM_FORCE_INLINE void NormByLogarithms(double p, const ThreeFours& u, Four* h,
                                          ThreeFours* by_log_u) {
  if (p == kCuboidExponent) {
    *h = u[0] + u[1] + u[2];
    *by_log_u = u;
    return;
  }
  if (p == kEllipsoidExponent) {
    const Four squares = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
    SquareRoot(squares, h);
    const Four inverse = *h > 0.0 ? 1.0 / *h : Four{};
    for (size_t i = 0; i < 3; ++i) (*by_log_u)[i] = u[i] * u[i] * inverse;
    return;
  }
  for (size_t k = 0; k < 4; ++k) {
    const Eigen::Array3d u_of_one(u[0][k], u[1][k], u[2][k]);
    double norm = 0.0;
    Eigen::Array3d by_u = Eigen::Array3d::Zero();
    if (!(u_of_one == 0.0).all()) by_u = NormByComponents(u_of_one, p, &norm);
    (*h)[k] = norm;
    for (size_t i = 0; i < 3; ++i) (*by_log_u)[i][k] = by_u[i] * u_of_one[i];
  }
}

// Squares of the rounded |m_i|: m_i^2 + e^2 |m|^2.
SOSLAM_FORCE_INLINE void SquaresOfRounded(double shape_exponent, const ThreeFours& m,
                                          ThreeFours* squares) {
  for (size_t i = 0; i < 3; ++i) (*squares)[i] = m[i] * m[i];
  const Four rounding =
      SquaredRounding(shape_exponent) * ((*squares)[0] + (*squares)[1] + (*squares)[2]);
  for (Four& square : *squares) square += rounding;
}

// SupportFunction of one body in four directions m, not zero, at once.
struct SupportOfFour {
  ThreeFours inverse_squares;  // 1 / |m_i|^2, rounded; unset for an ellipsoid
  Four extent;                 // h
  Four inverse;                // 1 / h; 0 for a flat body across its plane
  ThreeFours by_log_half_axes;
  ThreeFours shares;  // by_log_half_axes / |m_i|^2, rounded

  // The support point dh / dm.
  SOSLAM_FORCE_INLINE ThreeFours Contact(double shape_exponent, const ThreeFours& m) const {
    const Four rounding = SquaredRounding(shape_exponent) * (shares[0] + shares[1] + shares[2]);
    ThreeFours contact;
    for (size_t i = 0; i < 3; ++i) contact[i] = (shares[i] + rounding) * m[i];
    return contact;
  }
};

SOSLAM_FORCE_INLINE void FindSupport(const Eigen::Vector3d& half_axes, double shape_exponent,
                                     const ThreeFours& m, SupportOfFour* support) {
  const double p = shape_exponent;
  const bool is_ellipsoid = p == kEllipsoidExponent;
  ThreeFours squares, u;
  SquaresOfRounded(p, m, &squares);
  for (size_t i = 0; i < 3; ++i) {
    Four rounded = m[i];
    if (!is_ellipsoid) SquareRoot(squares[i], &rounded);
    u[i] = half_axes[static_cast<int>(i)] * rounded;
  }
  NormByLogarithms(p, u, &support->extent, &support->by_log_half_axes);
  support->inverse = support->extent > 0.0 ? 1.0 / support->extent : Four{};
  for (size_t i = 0; i < 3; ++i) {
    const double half_axis = half_axes[static_cast<int>(i)];
    if (is_ellipsoid) {
      support->shares[i] = half_axis * half_axis * support->inverse;
    } else {
      support->inverse_squares[i] = 1.0 / squares[i];
      support->shares[i] = support->by_log_half_axes[i] * support->inverse_squares[i];
    }
  }
}

}  // namespace soslam

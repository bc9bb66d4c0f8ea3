// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace soslam {

// The two exponents of a superquadric about its z axis: of its horizontal sections, and of the
// curve that joins them. Both 1: cuboid; both 2: ellipsoid; 2 and 1: cylinder. They are those of
// the support function; DualExponents are those of the surface (2 / e of Barr's exponents e2, e1,
// "Superquadrics and angle-preserving transformations", 1981).
struct ShapeExponents {
  double horizontal;
  double vertical;

  // NOLINTNEXTLINE(google-explicit-constructor): one number is a superquadric without special axis
  constexpr ShapeExponents(double both) : horizontal(both), vertical(both) {}
  constexpr ShapeExponents(double of_sections, double of_curve)
      : horizontal(of_sections), vertical(of_curve) {}

  // False for bodies that are the same about x, y and z, but for their half axes.
  constexpr bool HasAxis() const { return horizontal != vertical; }
  // One exponent for both, for a body whose axis does not stay vertical.
  constexpr double Mean() const { return 0.5 * (horizontal + vertical); }

  bool operator==(const ShapeExponents&) const = default;
};

inline constexpr double kCuboidExponent = 1.0;
inline constexpr double kEllipsoidExponent = 2.0;

// The exponents q of 1 / p + 1 / q = 1. Infinite for p = 1, and for bodies whose edges are too
// sharp to be told from it.
ShapeExponents DualExponents(const ShapeExponents& exponents);

// |x|^exponent, to a few units of the last digit, in half the time of std::pow. For most shape
// exponents (1.1, 1.2, 1.4, 1.5) twice those of the dual norm are integers: products and a root
// then take a fraction of that.
double AbsolutePower(double x, double exponent);

// The norm || ( || (u_1, u_2) ||_horizontal, u_3 ) ||_vertical, exponents from 1 to infinity, and
// its derivatives by u, all at most 1.
struct NormValue {
  double value;
  Eigen::Array3d slopes;
};
// `hessian` may be null; u is not zero where it is asked for. Exponents of 1 and infinity, whose
// norms are linear but for their kinks, add nothing to it.
NormValue SuperquadricNorm(const Eigen::Array3d& u, const ShapeExponents& exponents,
                           Eigen::Matrix3d* hessian = nullptr);

}  // namespace soslam

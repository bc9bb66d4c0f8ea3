// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

#include "soslam/base/description.h"

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

// `absent`: the exponent of files without any.
template <typename Visitor>
void DescribeExponents(Visitor& visit, ShapeExponents& exponents, double absent) {
  constexpr Limits kExponents = {1.0, 2.0};
  std::optional<double> vertical;
  if (exponents.HasAxis()) vertical = exponents.vertical;
  visit.OrDefault("shape_exponent", &exponents.horizontal, absent,
                  "of the horizontal sections: 1 rectangle, 2 ellipse, superellipses in between",
                  kExponents);
  visit.OrAbsent("vertical_exponent", &vertical,
                 "of the curve that joins the horizontal sections: 1 and a shape_exponent of 2 are "
                 "a cylinder; absent: that of the sections",
                 kExponents);
  visit.AfterReading([&] { exponents.vertical = vertical.value_or(exponents.horizontal); });
}

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

// The support function at a direction, and its derivatives.
struct SupportValue {
  double extent;                    // h, in metres where |m| = 1
  Eigen::Vector3d point;            // dh / dm: the support point
  Eigen::Vector3d d_log_half_axes;  // dh / d log (a, b, c)
};
inline constexpr double kEdgeRounding = 1e-3;

// Support function of a superquadric with half axes (a, b, c) in a direction m of the object frame,
// of any length: the maximum of m . x over the body, which is the SuperquadricNorm of (a m_1,
// b m_2, c m_3). The body itself is F(x) = || (x / a, y / b, z / c) || <= 1 by the norm with the
// DualExponents.
//
// For exponents below 2 the norm has kinks where a component of m vanishes. |m_i| is therefore
// replaced by sqrt(m_i^2 + e^2 |m|^2) with e = kEdgeRounding (2 - p), p the smaller exponent: the
// exact norm at p = 2, otherwise still convex and homogeneous, hence the support function of a body
// whose edges are rounded by a thousandth of its size.
//
// Requires 1 <= exponents <= 2, half_axes >= 0, and a direction that is not zero.
SupportValue SupportFunction(const Eigen::Vector3d& half_axes, const ShapeExponents& exponents,
                             const Eigen::Vector3d& direction_in_object);

// The Hessian d^2 h / dm^2: positive semidefinite, as a support function is convex, with m in its
// null space, as it is homogeneous. Zero where SupportFunction has no extent.
Eigen::Matrix3d SupportHessian(const Eigen::Vector3d& half_axes, const ShapeExponents& exponents,
                               const Eigen::Vector3d& direction_in_object);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/geometry/support_function.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace soslam {
namespace {

// Exponents q above this are treated as infinite.
constexpr double kLargestDual = 200.0;

double DualExponent(double exponent) {
  const double dual = exponent / (exponent - 1.0);
  return exponent > 1.0 && dual <= kLargestDual ? dual : std::numeric_limits<double>::infinity();
}

// || (x, y) ||_p with its derivatives; x, y >= 0.
struct PairNorm {
  double value;
  double d_x;
  double d_y;
};

PairNorm NormOfPair(double x, double y, double p) {
  if (p == 1.0) return {x + y, 1.0, 1.0};
  const bool is_x_larger = x >= y;
  const double larger = is_x_larger ? x : y;
  if (!(larger > 0.0)) return {0.0, 0.0, 0.0};
  double d_larger = 1.0;
  double d_smaller = 0.0;
  double value = larger;
  if (!std::isinf(p)) {
    const double ratio = (is_x_larger ? y : x) / larger;  // at most 1: powers stay finite
    const double power = AbsolutePower(ratio, p - 1.0);
    const double sum = 1.0 + ratio * power;
    const double root = AbsolutePower(sum, 1.0 / p);
    value = larger * root;
    d_larger = root / sum;
    d_smaller = power * d_larger;
  }
  return is_x_larger ? PairNorm{value, d_larger, d_smaller} : PairNorm{value, d_smaller, d_larger};
}

// The factor p - 1 of a norm's curvature; 0 where the norm is linear but for its kinks.
double Curvature(double p) { return std::isinf(p) ? 0.0 : p - 1.0; }

// (u / norm)^(p - 2), the part of a component in the curvature, from its slope (u / norm)^(p - 1).
// 0 at u = 0 where p < 2, as the norm has a kink there.
double CurvatureAlong(double u, double slope, double norm, double p) {
  if (std::isinf(p)) return 0.0;
  if (!(u > 0.0)) return p == 2.0 ? 1.0 : 0.0;
  return slope * norm / u;
}

// e^2 of the rounding.
double SquaredRounding(const ShapeExponents& exponents) {
  const double rounding =
      kEdgeRounding * (kEllipsoidExponent - std::min(exponents.horizontal, exponents.vertical));
  return rounding * rounding;
}

// The rounded |m_i|; nowhere zero but for the ellipsoid, which has no kinks.
Eigen::Array3d RoundedDirection(const Eigen::Vector3d& direction, double squared_rounding) {
  return (direction.array().square() + squared_rounding * direction.squaredNorm()).sqrt();
}

}  // namespace

double AbsolutePower(double x, double exponent) {
  constexpr double kRounding = 1e-12;  // of q = p / (p - 1)
  const double halves = std::round(2.0 * exponent);
  if (exponent < 0.0 || std::abs(2.0 * exponent - halves) > kRounding) {
    return std::exp(exponent * std::log(std::abs(x)));
  }
  const int whole_halves = static_cast<int>(halves);
  double power = whole_halves % 2 == 1 ? std::sqrt(std::abs(x)) : 1.0;
  double squared = std::abs(x);
  for (int whole = whole_halves / 2; whole > 0; whole /= 2) {
    if (whole % 2 == 1) power *= squared;
    squared *= squared;
  }
  return power;
}

ShapeExponents DualExponents(const ShapeExponents& exponents) {
  return {DualExponent(exponents.horizontal), DualExponent(exponents.vertical)};
}

NormValue SuperquadricNorm(const Eigen::Array3d& u, const ShapeExponents& exponents,
                           Eigen::Matrix3d* hessian) {
  const auto [of_sections, of_curve] = exponents;
  const Eigen::Array3d size = u.abs();
  const PairNorm section = NormOfPair(size.x(), size.y(), of_sections);
  const PairNorm norm = NormOfPair(section.value, size.z(), of_curve);
  const Eigen::Vector3d section_slopes(std::copysign(section.d_x, u.x()),
                                       std::copysign(section.d_y, u.y()), 0.0);
  const Eigen::Vector3d slopes =
      norm.d_x * section_slopes + std::copysign(norm.d_y, u.z()) * Eigen::Vector3d::UnitZ();
  if (hessian != nullptr && exponents == kEllipsoidExponent) {
    *hessian = (Eigen::Matrix3d::Identity() - slopes * slopes.transpose()) / norm.value;
  } else if (hessian != nullptr) {
    // d^2 ||v||_p / dv^2 = (p - 1) / ||v||_p (diag((|v_i| / ||v||_p)^(p - 2)) - g g^T), g the
    // slopes; first of the section within the norm, then of the norm.
    hessian->setZero();
    if (section.value > 0.0) {
      *hessian -= section_slopes * section_slopes.transpose();
      (*hessian)(0, 0) += CurvatureAlong(size.x(), section.d_x, section.value, of_sections);
      (*hessian)(1, 1) += CurvatureAlong(size.y(), section.d_y, section.value, of_sections);
      *hessian *= norm.d_x * Curvature(of_sections) / section.value;
    }
    Eigen::Matrix3d outer = -slopes * slopes.transpose();
    outer += CurvatureAlong(section.value, norm.d_x, norm.value, of_curve) * section_slopes *
             section_slopes.transpose();
    outer(2, 2) += CurvatureAlong(size.z(), norm.d_y, norm.value, of_curve);
    *hessian += Curvature(of_curve) / norm.value * outer;
  }
  return {norm.value, slopes};
}

SupportValue SupportFunction(const Eigen::Vector3d& half_axes, const ShapeExponents& exponents,
                             const Eigen::Vector3d& direction_in_object) {
  const double squared_rounding = SquaredRounding(exponents);
  const Eigen::Array3d rounded = RoundedDirection(direction_in_object, squared_rounding);
  const Eigen::Array3d u = half_axes.array() * rounded;
  const auto [extent, slopes] = SuperquadricNorm(u, exponents);
  // d u_i / d m_j = s_i (m_i [i = j] + e^2 m_j) / rounded_i
  const Eigen::Array3d d_squares =
      (rounded > 0.0).select(slopes * half_axes.array() / rounded, 0.0);
  return {extent, (d_squares + d_squares.sum() * squared_rounding) * direction_in_object.array(),
          slopes * u};
}

Eigen::Matrix3d SupportHessian(const Eigen::Vector3d& half_axes, const ShapeExponents& exponents,
                               const Eigen::Vector3d& direction_in_object) {
  const Eigen::Vector3d& m = direction_in_object;
  const double squared_rounding = SquaredRounding(exponents);
  const Eigen::Array3d rounded = RoundedDirection(m, squared_rounding);
  Eigen::Matrix3d by_u;
  const auto [extent, slopes] = SuperquadricNorm(half_axes.array() * rounded, exponents, &by_u);
  if (!(extent > 0.0)) return Eigen::Matrix3d::Zero();
  // With r_i the rounded |m_i|: dr_i / dm = (m_i e_i + e^2 m) / r_i, and
  // d^2 r_i / dm^2 = (e_i e_i^T + e^2 I - (dr_i / dm) (dr_i / dm)^T) / r_i.
  Eigen::Matrix3d d_rounded;  // row i: dr_i / dm
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d unit = Eigen::Vector3d::Unit(i);
    if (!(rounded[i] > 0.0)) {  // the ellipsoid, where |m_i| has the slope of m_i
      d_rounded.row(i) = unit.transpose();
      continue;
    }
    const Eigen::Vector3d slope = (m[i] * unit + squared_rounding * m) / rounded[i];
    d_rounded.row(i) = slope.transpose();
    hessian += slopes[i] * half_axes[i] / rounded[i] *
               (unit * unit.transpose() + squared_rounding * Eigen::Matrix3d::Identity() -
                slope * slope.transpose());
  }
  const Eigen::Matrix3d d_u = half_axes.asDiagonal() * d_rounded;
  return hessian + d_u.transpose() * by_u * d_u;
}

}  // namespace soslam

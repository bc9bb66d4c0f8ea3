// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <numbers>

#include "base/wide_loops.h"

namespace soslam {

// The first kCount coefficients f_n of a series sum over n of f_n x^n, from f_0 and the ratios f_n
// / f_(n - 1).
template <size_t kCount, typename Ratio>
constexpr std::array<double, kCount> SeriesByRatios(double first, Ratio ratio) {
  std::array<double, kCount> factors{first};
  for (size_t n = 1; n < kCount; ++n) {
    factors[n] = factors[n - 1] * ratio(static_cast<double>(n));
  }
  return factors;
}

// Sums the series for several x at once: the steps of one x depend on each other, those of
// different x do not.
template <size_t kSize, size_t kCount>
SOSLAM_FORCE_INLINE void SumSeries(const std::array<double, kSize>& factors,
                                   const std::array<Four, kCount>& x,
                                   std::array<Four, kCount>* sums) {
  *sums = {};
  for (size_t n = kSize; n-- > 0;) {
    for (size_t i = 0; i < kCount; ++i) (*sums)[i] = factors[n] + x[i] * (*sums)[i];
  }
}

// e^x with a relative error of 1e-14. NaN and x below -708 count as -708, x above 709 as 709, so
// that the powers of two are normal numbers.
template <size_t kCount>
SOSLAM_FORCE_INLINE void Exponential(std::array<Four, kCount> x,
                                     std::array<Four, kCount>* exponential) {
  constexpr double kLeast = -708.0, kMost = 709.0;
  // A double to which this is added has no bits left for its fraction: the lowest bits hold the
  // nearest integer.
  constexpr double kRounding = 0x1.8p52;
  // ln 2 in two parts, the first with so few bits that its product with a power is exact.
  constexpr double kLn2 = 0x1.62e42feep-1, kRestOfLn2 = 0x1.a39ef35793c76p-33;
  constexpr int kExponent = 52;  // lowest bit of a double's exponent
  constexpr auto kFactors = SeriesByRatios<12>(1.0, [](double n) { return 1.0 / n; });

  std::array<FourMask, kCount> powers;
  for (size_t i = 0; i < kCount; ++i) {
    x[i] = x[i] > kLeast ? x[i] : Four{} + kLeast;
    x[i] = x[i] < kMost ? x[i] : Four{} + kMost;
    const Four rounded = x[i] * std::numbers::log2e + kRounding;
    const Four power = rounded - kRounding;
    x[i] = (x[i] - power * kLn2) - power * kRestOfLn2;
    powers[i] = reinterpret_cast<FourMask>(rounded) << kExponent;
  }
  std::array<Four, kCount> rest;
  SumSeries(kFactors, x, &rest);
  for (size_t i = 0; i < kCount; ++i) {
    (*exponential)[i] = reinterpret_cast<Four>(reinterpret_cast<FourMask>(rest[i]) + powers[i]);
  }
}

}  // namespace soslam

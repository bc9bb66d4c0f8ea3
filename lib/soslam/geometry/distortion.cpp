// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/geometry/distortion.h"

#include <algorithm>
#include <array>

namespace soslam {
namespace {

// Coefficients in OpenCV's order.
constexpr std::array kCoefficients = {
    &Distortion::k1, &Distortion::k2, &Distortion::p1,    &Distortion::p2,   &Distortion::k3,
    &Distortion::k4, &Distortion::k5, &Distortion::k6,    &Distortion::s1,   &Distortion::s2,
    &Distortion::s3, &Distortion::s4, &Distortion::tau_x, &Distortion::tau_y};

// Numbers of coefficients that OpenCV accepts.
constexpr std::array<size_t, 5> kCounts = {4, 5, 8, 12, 14};

}  // namespace

std::vector<double> DistortionCoefficients(const Distortion& distortion) {
  std::vector<double> coefficients;
  for (const auto coefficient : kCoefficients) coefficients.push_back(distortion.*coefficient);
  const auto is_zero_from = [&](size_t count) {
    return std::all_of(coefficients.begin() + static_cast<std::ptrdiff_t>(count),
                       coefficients.end(), [](double k) { return k == 0.0; });
  };
  for (const size_t count : {5, 8, 12}) {
    if (!is_zero_from(count)) continue;
    coefficients.resize(count);
    break;
  }
  return coefficients;
}

std::optional<Distortion> DistortionOfCoefficients(std::span<const double> coefficients) {
  if (std::ranges::find(kCounts, coefficients.size()) == kCounts.end()) return std::nullopt;
  Distortion distortion;
  for (size_t i = 0; i < coefficients.size(); ++i) distortion.*kCoefficients[i] = coefficients[i];
  return distortion;
}

}  // namespace soslam

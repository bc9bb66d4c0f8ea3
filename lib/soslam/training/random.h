// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>

namespace soslam {

// Random numbers that are the same with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  double Uniform(double from, double to) {
    return from + (to - from) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  bool Chance(double probability) { return Uniform(0.0, 1.0) < probability; }
  size_t Index(size_t count) { return engine_() % count; }
  double Normal(double sigma) {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - Uniform(0.0, 1.0)));
    return sigma * radius * std::cos(2.0 * std::numbers::pi * Uniform(0.0, 1.0));
  }
  // Independent numbers.
  Eigen::Vector3f Normals(double sigma) {
    const double x = Normal(sigma), y = Normal(sigma), z = Normal(sigma);
    return Eigen::Vector3d(x, y, z).cast<float>();
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace soslam

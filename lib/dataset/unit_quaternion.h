// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "base/error.h"

namespace soslam {

// Normalises a quaternion that was rounded in a file. Throws InputError, naming `place`, when its
// norm differs from 1 by more than rounding.
inline Eigen::Quaterniond UnitQuaternion(const Eigen::Vector4d& xyzw, const std::string& place) {
  constexpr double kTolerance = 1e-2;
  if (!(std::abs(xyzw.norm() - 1.0) <= kTolerance)) {
    throw InputError(fmt::format("{}: quaternion has norm {:.6g}; expected 1", place, xyzw.norm()));
  }
  return Eigen::Quaterniond(xyzw).normalized();
}

}  // namespace soslam

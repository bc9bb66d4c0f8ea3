// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "base/error.h"

namespace soslam {

// Files round quaternions, so that their norm is only about 1; this makes it 1. Throws InputError,
// naming `place`, when it is off by more than rounding explains.
inline Eigen::Quaterniond UnitQuaternion(const Eigen::Vector4d& xyzw, const std::string& place) {
  constexpr double kTolerance = 1e-2;
  if (!(std::abs(xyzw.norm() - 1.0) <= kTolerance)) {
    throw InputError(fmt::format("{}: quaternion has norm {:.6g}; expected 1", place, xyzw.norm()));
  }
  return Eigen::Quaterniond(xyzw).normalized();
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace soslam {

inline constexpr double kDegPerRad = 180.0 / std::numbers::pi;
inline constexpr double kRadPerDeg = std::numbers::pi / 180.0;

// Angle between two directions of any length above 0: 0 to pi, or 0 to 180.
inline double AngleBetween(const Eigen::Vector3d& one, const Eigen::Vector3d& other) {
  return std::atan2(one.cross(other).norm(), one.dot(other));
}
inline double AngleBetweenDeg(const Eigen::Vector3d& one, const Eigen::Vector3d& other) {
  return kDegPerRad * AngleBetween(one, other);
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/rotation_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "geometry/landmark.h"
#include "geometry/rigid3.h"

namespace soslam {

NearestAxes NearestAxesOf(const Eigen::Quaterniond& frame_from_estimate,
                          const Eigen::Quaterniond& frame_from_truth) {
  const Eigen::Matrix3d truth_from_estimate =
      (frame_from_truth.conjugate() * frame_from_estimate).toRotationMatrix();
  NearestAxes nearest{Eigen::Matrix3d::Identity(), std::numbers::pi};
  std::array<int, 3> axes = {0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Eigen::Matrix3d cube = Eigen::Matrix3d::Zero();
      for (int i = 0; i < 3; ++i) {
        cube(i, axes[static_cast<size_t>(i)]) = (signs >> i & 1) != 0 ? -1.0 : 1.0;
      }
      if (cube.determinant() < 0.0) continue;
      const Eigen::Quaterniond difference(Eigen::Matrix3d(truth_from_estimate * cube));
      const double angle = LogRotation(difference.normalized()).norm();
      if (angle < nearest.angle) nearest = {cube, angle};
    }
  } while (std::next_permutation(axes.begin(), axes.end()));
  return nearest;
}

double RotationError(const Eigen::Quaterniond& frame_from_estimate,
                     const Eigen::Quaterniond& frame_from_truth) {
  return NearestAxesOf(frame_from_estimate, frame_from_truth).angle;
}

double YawError(const Eigen::Quaterniond& frame_from_estimate,
                const Eigen::Quaterniond& frame_from_truth) {
  const Eigen::Vector3d front =
      frame_from_truth.conjugate() * (frame_from_estimate * Eigen::Vector3d::UnitX());
  if (front.head<2>().norm() < 1e-9) return std::numbers::pi / 2.0;
  return std::abs(YawDifferenceModuloPi(std::atan2(front.y(), front.x()), 0.0));
}

}  // namespace soslam

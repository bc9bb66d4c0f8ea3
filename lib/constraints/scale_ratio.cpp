// SPDX-License-Identifier: BSD-3-Clause
#include "constraints/scale_ratio.h"

#include <cmath>

namespace soslam {

ScaleRatioResidual::ScaleRatioResidual(const Eigen::Vector2d& ratio, double variance)
    : ratio_(ratio), weight_(1.0 / std::sqrt(variance)) {}

bool ScaleRatioResidual::Evaluate(double const* const* blocks, double* residuals,
                                  double** jacobians) const {
  const double* log_half_axes = blocks[0] + kPoseSize;
  const double a_by_c = std::exp(log_half_axes[0] - log_half_axes[2]);
  const double b_by_c = std::exp(log_half_axes[1] - log_half_axes[2]);
  if (!std::isfinite(a_by_c) || !std::isfinite(b_by_c))
    return false;  // the step was too large: the solver shortens it
  residuals[0] = weight_ * (a_by_c - ratio_.x());
  residuals[1] = weight_ * (b_by_c - ratio_.y());
  if (jacobians != nullptr && jacobians[0] != nullptr) {
    Eigen::Map<Eigen::Matrix<double, 2, kLandmarkSize, Eigen::RowMajor>> map(jacobians[0]);
    map.setZero();
    map.rightCols<3>() << a_by_c, 0.0, -a_by_c, 0.0, b_by_c, -b_by_c;
    map *= weight_;
  }
  return true;
}

}  // namespace soslam

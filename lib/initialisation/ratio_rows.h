// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "initialisation/semantic_table.h"

namespace soslam {

// Prior of the ratios a / c and b / c as two residuals of unit variance that are linear in the
// logarithms of the half axes: that of the first ratio, and that of the second given the first
// (whitened by the inverse Cholesky factor of their covariance).
struct RatioRows {
  explicit RatioRows(const ShapePrior& prior);

  Eigen::Vector2d Residuals(const Eigen::Vector3d& log_half_axes) const {
    return by_log_half_axes * log_half_axes - at_prior;
  }

  Eigen::Matrix<double, 2, 3> by_log_half_axes;
  Eigen::Vector2d at_prior;
  Eigen::Matrix3d information;  // J^T J, J = by_log_half_axes
};

}  // namespace soslam

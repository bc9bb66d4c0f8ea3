// SPDX-License-Identifier: BSD-3-Clause
#include "constraints/log_ratio.h"

namespace soslam {

LogRatioResidual::LogRatioResidual(const Eigen::Vector2d& ratio, const Eigen::Vector2d& log_sigma)
    : log_ratio_(ratio.array().log()), weight_(log_sigma.cwiseInverse()) {}

bool LogRatioResidual::Evaluate(double const* const* blocks, double* residuals,
                                double** jacobians) const {
  const double* log_half_axes = blocks[0] + kPoseSize;
  for (int i = 0; i < 2; ++i) {
    residuals[i] = weight_[i] * (log_half_axes[i] - log_half_axes[2] - log_ratio_[i]);
  }
  if (jacobians != nullptr && jacobians[0] != nullptr) {
    Eigen::Map<Eigen::Matrix<double, 2, kLandmarkSize, Eigen::RowMajor>> map(jacobians[0]);
    map.setZero();
    map.rightCols<3>() << weight_[0], 0.0, -weight_[0], 0.0, weight_[1], -weight_[1];
  }
  return true;
}

}  // namespace soslam

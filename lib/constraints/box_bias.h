// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/sized_cost_function.h>

#include "constraints/tangent_space.h"

namespace soslam {

// Keeps a detector's bias near zero. Residuals: 4 (left, top, right and bottom edges), each divided
// by sigma. Block: the bias (px).
class BoxBiasResidual final : public ceres::SizedCostFunction<kBiasSize, kBiasSize> {
 public:
  explicit BoxBiasResidual(double sigma_px) : weight_(1.0 / sigma_px) {}

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    Eigen::Map<Eigen::Vector4d> values(residuals);
    values = weight_ * Eigen::Vector4d(blocks[0]);
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<Eigen::Matrix4d> by_bias(jacobians[0]);
      by_bias = weight_ * Eigen::Matrix4d::Identity();
    }
    return true;
  }

 private:
  double weight_;
};

}  // namespace soslam

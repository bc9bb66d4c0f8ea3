// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/residual_batch.h"

#include <gtest/gtest.h>

#include "support/landmark_costs.h"
#include "support/random.h"

namespace soslam {
namespace {

TEST(ResidualBatch, AddsItsProducts) {
  Eigen::Matrix<double, kBatchSize, kLandmarkDof> jacobian;
  Eigen::Matrix<double, kBatchSize, 1> residuals;
  ResidualBatch batch = ResidualBatch::Zero();
  for (int i = 0; i < kBatchSize; ++i) {
    batch.residual[i] = residuals[i] = RandomUniform(-1, 1);
    for (int k = 0; k < kLandmarkDof; ++k) {
      batch.by_landmark[static_cast<size_t>(k)][i] = jacobian(i, k) = RandomUniform(-1, 1);
    }
  }
  const double weight = 0.3;
  LandmarkModel sum;
  batch.AddTo(weight, &sum);
  LandmarkModel expected{0.5 * weight * residuals.squaredNorm(),
                         weight * jacobian.transpose() * residuals,
                         weight * jacobian.transpose() * jacobian};
  ExpectSameModels(sum, expected);
  batch.AddTo(weight, &sum);
  expected.Add(LandmarkModel(expected));
  ExpectSameModels(sum, expected);
}

}  // namespace
}  // namespace soslam

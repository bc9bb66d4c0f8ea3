// SPDX-License-Identifier: BSD-3-Clause
#include "constraints/box_bias.h"

#include <gtest/gtest.h>

#include "support/jacobians.h"

namespace soslam {
namespace {

TEST(BoxBiasResidual, IsTheBiasInStandardDeviations) {
  const BoxBiasResidual residual(0.25);
  const double bias[] = {-1.5, 0.0, 2.0, 0.5};
  const double* blocks[] = {bias};
  Eigen::Vector4d values;
  EXPECT_TRUE(residual.Evaluate(blocks, values.data(), nullptr));
  EXPECT_EQ(values, 4.0 * Eigen::Vector4d(bias));
  ExpectCorrectJacobians(residual, {bias});
}

}  // namespace
}  // namespace soslam

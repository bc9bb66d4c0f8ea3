// SPDX-License-Identifier: BSD-3-Clause
#include "constraints/bias.h"

#include <gtest/gtest.h>

#include "support/jacobians.h"

namespace soslam {
namespace {

TEST(BiasResidual, IsTheValueInStandardDeviations) {
  const BiasResidual residual(0.25);
  for (const double bias : {-1.5, 0.0, 2.0}) {
    const double* blocks[] = {&bias};
    double value = 0.0;
    EXPECT_TRUE(residual.Evaluate(blocks, &value, nullptr));
    EXPECT_DOUBLE_EQ(value, 4.0 * bias);
    ExpectCorrectJacobians(residual, {&bias});
  }
}

}  // namespace
}  // namespace soslam

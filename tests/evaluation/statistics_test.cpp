// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/evaluation/statistics.h"

#include <gtest/gtest.h>

namespace soslam {
namespace {

// Quantiles of tables, within the error of the approximation.
TEST(FisherTailTest, HasTheValuesOfTables) {
  EXPECT_NEAR(FisherTail(2.71, 5.0, 20.0), 0.05, 0.002);
  EXPECT_NEAR(FisherTail(21.04, 1.0, 10.0), 0.001, 2e-4);
  EXPECT_NEAR(FisherTail(7.05, 3.0, 30.0), 0.001, 2e-4);
  EXPECT_NEAR(FisherTail(3.69, 9.0, 60.0), 0.001, 2e-4);
}

}  // namespace
}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/geometry/similarity.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/random.h"

namespace soslam {
namespace {

TEST(Similarity, AProductAppliesOneAfterTheOther) {
  for (int i = 0; i < 100; ++i) {
    const Similarity one{std::exp(RandomUniform(-2, 2)), RandomRigid()};
    const Similarity other{std::exp(RandomUniform(-2, 2)), RandomRigid()};
    const Eigen::Vector3d point = RandomVector(-3, 3);
    EXPECT_LT(((one * other) * point - one * (other * point)).norm(), 1e-10);
  }
}

}  // namespace
}  // namespace soslam

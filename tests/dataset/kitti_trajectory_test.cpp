// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "dataset/trajectories.h"
#include "support/expect_error.h"
#include "support/random.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

class KittiTrajectoryTest : public testing::Test {
 protected:
  std::vector<Rigid3d> Read(const std::string& text) {
    WriteBytes(folder_ / "poses.txt", text);
    return ReadKittiTrajectory(folder_ / "poses.txt");
  }
  TemporaryFolder folder_;
};

TEST_F(KittiTrajectoryTest, RoundedMatricesBecomeRotations) {
  for (int i = 0; i < 50; ++i) {
    const Rigid3d pose = RandomRigid();
    std::string line;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column) {
        line += fmt::format("{:.4f} ", pose.Matrix()(row, column));
      }
    }
    const Rigid3d read = Read(line).front();
    EXPECT_NEAR(read.rotation.norm(), 1.0, 1e-12);
    // Rounding to four digits is 5e-5 in each of the numbers.
    EXPECT_LT((read.Matrix() - pose.Matrix()).norm(), 4e-4);
  }
}

TEST_F(KittiTrajectoryTest, BadLinesAreNamed) {
  const BadTexts cases = {{"1 0 0 0 0 1 0 0 0 0 1", {"has 11 numbers", "12"}},
                          {"1 0 0 0 0 1 0 0 0 0 1 0 0", {"has 13 numbers"}},
                          {"1 0 0 0 0 1 0 x 0 0 1 0", {"number 8 is 'x'"}},
                          {"1 0 0 0 0 1 0 nan 0 0 1 0", {"number 8 is 'nan'"}},
                          {"1.01 0 0 0 0 1 0 0 0 0 1 0", {"not orthonormal", "0.0201", "0.001"}},
                          {"1 0.002 0 0 0 1 0 0 0 0 1 0", {"not orthonormal"}},
                          {"0 0 0 0 0 0 0 0 0 0 0 0", {"not orthonormal"}},
                          {"1 0 0 0 0 -1 0 0 0 0 1 0", {"determinant -1"}}};
  ExpectBadTexts(cases, "poses.txt:2",
                 [&](const std::string& line) { Read("1 0 0 0 0 1 0 0 0 0 1 0\n" + line); });
  ExpectError<InputError>([&] { Read("\n"); }, {"poses.txt", "no pose"});
}

}  // namespace
}  // namespace soslam

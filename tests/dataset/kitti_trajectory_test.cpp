// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/kitti_trajectory.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

class KittiTrajectoryTest : public testing::Test {
 protected:
  std::vector<Rigid3d> Read(const std::string& text) {
    WriteBytes(folder_ / "poses.txt", text);
    return ReadKittiTrajectory(folder_ / "poses.txt");
  }
  void ExpectRefused(const std::string& text, const std::vector<std::string>& words) {
    ExpectError<InputError>([&] { Read(text); }, words);
  }
  TemporaryFolder folder_;
};

// A quarter turn about y: the camera looks along the world's x axis.
TEST_F(KittiTrajectoryTest, ReadsMatricesByRows) {
  const auto poses = Read("1 0 0 0 0 1 0 0 0 0 1 0\n0 0 1 2 0 1 0 3 -1 0 0 4\n");
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[0].translation, Eigen::Vector3d::Zero());
  const Eigen::Vector3d ahead = poses[1] * Eigen::Vector3d(0, 0, 1);
  EXPECT_LT((ahead - Eigen::Vector3d(3, 3, 4)).norm(), 1e-12);
}

TEST_F(KittiTrajectoryTest, RefusesWhatIsNoPose) {
  ExpectRefused("", {"poses.txt", "no pose"});
  ExpectRefused("1 0 0 0 0 1 0 0 0 0 1\n", {"poses.txt:1", "11 numbers"});
  ExpectRefused("1 0 0 0 0 1 0 0 0 0 1 far\n", {"poses.txt:1", "number 12", "far"});
  ExpectRefused("1 0 0 0 0 1 0 0 0 0 1 0\n2 0 0 0 0 1 0 0 0 0 1 0\n", {"poses.txt:2", "rotation"});
  ExpectRefused("-1 0 0 0 0 1 0 0 0 0 1 0\n", {"poses.txt:1", "rotation"});
}

}  // namespace
}  // namespace soslam

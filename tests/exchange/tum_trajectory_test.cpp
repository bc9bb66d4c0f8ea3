// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "dataset/trajectories.h"
#include "exchange/text_exports.h"
#include "support/exported_world.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

TEST(TumTrajectoryTest, ReadsBackBitForBit) {
  World world = ExportedWorld();
  for (WorldFrame& frame : world.frames) {
    // Exactly those of a unit quaternion, for the reader divides by the norm.
    frame.world_from_camera = {Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5),
                               RandomVector(-1e-7, 1e-7) + RandomVector(-100, 100)};
  }
  const TemporaryFolder folder;
  WriteBytes(folder / "poses.txt", TumTrajectoryText(world));
  const std::vector<TimedPose> poses = ReadTrajectory(folder / "poses.txt");
  ASSERT_EQ(poses.size(), world.frames.size());
  for (size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(poses[i].timestamp, world.frames[i].timestamp);
    const Rigid3d& expected = world.frames[i].world_from_camera;
    EXPECT_EQ(poses[i].world_from_camera.translation, expected.translation);
    EXPECT_EQ(poses[i].world_from_camera.rotation.coeffs(), expected.rotation.coeffs());
  }
}

}  // namespace
}  // namespace soslam

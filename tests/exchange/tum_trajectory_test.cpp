// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/tum_trajectory.h"

#include <gtest/gtest.h>

#include "dataset/tum_list.h"
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

TEST(TumTrajectoryTest, OneLinePerFrameBelowAComment) {
  World world;
  world.frames = {{3, 0.25, "", {}, {Eigen::Quaterniond(0.8, 0.6, 0.0, 0.0), {1.5, -2.0, 1e-9}}}};
  EXPECT_EQ(TumTrajectoryText(world),
            "# world_from_camera: timestamp tx ty tz qx qy qz qw\n"
            "0.25 1.5 -2 1e-09 0.6 0 0 0.8\n");
}

}  // namespace
}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

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

// What evo's file_interface.read_tum_trajectory_file and PoseTrajectory3D.check ask for: rows of
// eight numbers with one blank between them, comments by "#" only, ascending times, unit
// quaternions.
TEST(TumTrajectoryTest, IsAsEvoWantsIt) {
  World world = ExportedWorld();
  std::swap(world.frames[0], world.frames[2]);  // images need not be listed in order of time
  std::istringstream text(TumTrajectoryText(world));
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with("#")) continue;
    rows.emplace_back();
    std::istringstream words(line);
    for (std::string word; std::getline(words, word, ' ');) {
      size_t read = 0;
      rows.back().push_back(std::stod(word, &read));
      EXPECT_EQ(read, word.size());
      EXPECT_TRUE(std::isfinite(rows.back().back()));
    }
    ASSERT_EQ(rows.back().size(), 8u) << line;
    EXPECT_NE(line.back(), ' ');
    const auto& row = rows.back();
    EXPECT_NEAR(Eigen::Vector4d(row[4], row[5], row[6], row[7]).norm(), 1.0, 1e-8);
  }
  ASSERT_EQ(rows.size(), world.frames.size());
  for (size_t i = 1; i < rows.size(); ++i) EXPECT_GT(rows[i][0], rows[i - 1][0]);
}

}  // namespace
}  // namespace soslam

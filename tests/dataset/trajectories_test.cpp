// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/dataset/trajectories.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "soslam/base/error.h"
#include "support/expect_error.h"
#include "support/random.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

std::vector<TimedPose> ReadEuroc(const std::string& text) {
  const TemporaryFolder folder;
  return ReadEurocTrajectory(WriteBytes(folder / "data.csv", text));
}

// A body at (1, 2, 3), turned by a quarter about z: x becomes y.
TEST(EurocTrajectoryTest, NanosecondsAndScalarFirst) {
  const auto poses = ReadEuroc(
      "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y [],"
      "q_RS_z [],v_RS_R_x [m s^-1]\r\n"
      "2500000000,1,2,3,0.70710678,0,0,0.70710678,9\r\n"
      "1403636579763555584, 4, 5, 6, 1, 0, 0, 0\r\n");
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[0].timestamp, 2.5);
  EXPECT_TRUE(
      (poses[0].world_from_camera * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(1, 3, 3)));
  EXPECT_NEAR(poses[1].timestamp, 1403636579.763555584, 1e-6);
  EXPECT_TRUE(poses[1].world_from_camera.rotation.isApprox(Eigen::Quaterniond::Identity()));
}

TEST(EurocTrajectoryTest, BadLinesAreNamed) {
  const BadTexts cases = {{"1,1,2,3,1,0,0", {"data.csv:1", "7 fields", "timestamp,x,y,z,qw"}},
                          {"1.5,1,2,3,1,0,0,0", {"timestamp is 1.5", "nanoseconds"}},
                          {"1,1,2,3,1,1,0,0", {"norm"}},
                          {"1,1,2,z,1,0,0,0", {"z is 'z'"}},
                          {"# nothing", {"no pose"}}};
  ExpectBadTexts(cases, "data.csv", &ReadEuroc);
}

std::vector<Rigid3d> ReadKitti(const std::string& text) {
  const TemporaryFolder folder;
  return ReadKittiTrajectory(WriteBytes(folder / "poses.txt", text));
}

TEST(KittiTrajectoryTest, RoundedMatricesBecomeRotations) {
  for (int i = 0; i < 50; ++i) {
    const Rigid3d pose = RandomRigid();
    std::string line;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column) {
        line += fmt::format("{:.4f} ", pose.Matrix()(row, column));
      }
    }
    const Rigid3d read = ReadKitti(line).front();
    EXPECT_NEAR(read.rotation.norm(), 1.0, 1e-12);
    // Rounding to four digits is 5e-5 in each of the numbers.
    EXPECT_LT((read.Matrix() - pose.Matrix()).norm(), 4e-4);
  }
}

TEST(KittiTrajectoryTest, BadLinesAreNamed) {
  const BadTexts cases = {{"1 0 0 0 0 1 0 0 0 0 1", {"has 11 numbers", "12"}},
                          {"1 0 0 0 0 1 0 0 0 0 1 0 0", {"has 13 numbers"}},
                          {"1 0 0 0 0 1 0 x 0 0 1 0", {"number 8 is 'x'"}},
                          {"1 0 0 0 0 1 0 nan 0 0 1 0", {"number 8 is 'nan'"}},
                          {"1.01 0 0 0 0 1 0 0 0 0 1 0", {"not orthonormal", "0.0201", "0.001"}},
                          {"1 0.002 0 0 0 1 0 0 0 0 1 0", {"not orthonormal"}},
                          {"0 0 0 0 0 0 0 0 0 0 0 0", {"not orthonormal"}},
                          {"1 0 0 0 0 -1 0 0 0 0 1 0", {"determinant -1"}}};
  ExpectBadTexts(cases, "poses.txt:2",
                 [&](const std::string& line) { ReadKitti("1 0 0 0 0 1 0 0 0 0 1 0\n" + line); });
  ExpectError<InputError>([&] { ReadKitti("\n"); }, {"poses.txt", "no pose"});
}

const Camera kPublished = {640, 480, 481.2, -480.0, 319.5, 239.5};

// What makes it right: any point of the published world is seen in the same pixel.
TEST(IclNuimTest, SameImages) {
  Camera with_y_down = kPublished;
  with_y_down.fy = -kPublished.fy;
  for (int i = 0; i < 200; ++i) {
    const Rigid3d world_from_camera = RandomRigid();
    const Eigen::Vector3d point_in_camera = {RandomUniform(-2, 2), RandomUniform(-2, 2),
                                             RandomUniform(1, 5)};
    const Eigen::Vector3d point_in_world = world_from_camera * point_in_camera;
    const Eigen::Vector3d mirrored_point(point_in_world.x(), -point_in_world.y(),
                                         point_in_world.z());
    const Rigid3d mirrored = MirroredInY(world_from_camera);
    const auto pixel = with_y_down.Project(mirrored.Inverse() * mirrored_point);
    ASSERT_TRUE(pixel);
    EXPECT_LT((*pixel - *kPublished.Project(point_in_camera)).norm(), 1e-8);
  }
}

}  // namespace
}  // namespace soslam

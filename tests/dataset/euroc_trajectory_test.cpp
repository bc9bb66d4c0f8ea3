// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "base/error.h"
#include "dataset/trajectories.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

class EurocTrajectoryTest : public testing::Test {
 protected:
  std::vector<TimedPose> Read(const std::string& text) {
    WriteBytes(folder_ / "data.csv", text);
    return ReadEurocTrajectory(folder_ / "data.csv");
  }
  TemporaryFolder folder_;
};

// A body at (1, 2, 3), turned by a quarter about z: x becomes y.
TEST_F(EurocTrajectoryTest, NanosecondsAndScalarFirst) {
  const auto poses = Read(
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

TEST_F(EurocTrajectoryTest, BadLinesAreNamed) {
  const BadTexts cases = {{"1,1,2,3,1,0,0", {"data.csv:1", "7 fields", "timestamp,x,y,z,qw"}},
                          {"1.5,1,2,3,1,0,0,0", {"timestamp is 1.5", "nanoseconds"}},
                          {"1,1,2,3,1,1,0,0", {"norm"}},
                          {"1,1,2,z,1,0,0,0", {"z is 'z'"}},
                          {"# nothing", {"no pose"}}};
  ExpectBadTexts(cases, "data.csv", [&](const std::string& line) { Read(line); });
}

}  // namespace
}  // namespace soslam

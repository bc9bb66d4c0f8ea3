// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "base/error.h"
#include "dataset/trajectories.h"
#include "support/expect_error.h"
#include "support/random.h"

namespace soslam {
namespace {

const Camera kPublished = {640, 480, 481.2, -480.0, 319.5, 239.5};

TEST(IclNuimTest, CameraWithYDownIsRefused) {
  Camera camera = kPublished;
  camera.fy = 480.0;
  ExpectError<InputError>([&] { WithYDown(camera); }, {"fy is 480", "negative"});
}

// What makes it right: any point of the published world is seen in the same pixel.
TEST(IclNuimTest, SameImages) {
  for (int i = 0; i < 200; ++i) {
    const Rigid3d world_from_camera = RandomRigid();
    const Eigen::Vector3d point_in_camera = {RandomUniform(-2, 2), RandomUniform(-2, 2),
                                             RandomUniform(1, 5)};
    const Eigen::Vector3d point_in_world = world_from_camera * point_in_camera;
    const Eigen::Vector3d mirrored_point(point_in_world.x(), -point_in_world.y(),
                                         point_in_world.z());
    const Rigid3d mirrored = MirroredInY(world_from_camera);
    const auto pixel = WithYDown(kPublished).Project(mirrored.Inverse() * mirrored_point);
    ASSERT_TRUE(pixel);
    EXPECT_LT((*pixel - *kPublished.Project(point_in_camera)).norm(), 1e-8);
  }
}

TEST(IclNuimTest, FrameNumbersBecomeSeconds) {
  const auto trajectory =
      FromIclNuim({{1, {Eigen::Quaterniond::Identity(), {1, 2, 3}}}, {31, RandomRigid()}});
  ASSERT_EQ(trajectory.size(), 2u);
  EXPECT_DOUBLE_EQ(trajectory[0].timestamp, 1.0 / 30.0);
  EXPECT_DOUBLE_EQ(trajectory[1].timestamp, 31.0 / 30.0);
  EXPECT_EQ(trajectory[0].world_from_camera.translation, Eigen::Vector3d(1, -2, 3));
}

}  // namespace
}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "soslam/base/error.h"
#include "soslam/dataset/nerfstudio.h"
#include "soslam/exchange/exports.h"
#include "support/expect_error.h"
#include "support/exported_world.h"
#include "support/folder_test.h"

namespace soslam {
namespace {

using nlohmann::json;

class TransformsTest : public FolderTest {
 protected:
  World world_ = ExportedWorld();
};

TEST_F(TransformsTest, DatasetReaderReadsThemBack) {
  world_.image_distortion = Distortion{.k1 = 0.1, .p1 = 0.01, .k3 = -0.02};
  for (WorldFrame& frame : world_.frames) frame.world_from_camera.rotation = RandomRotation();
  const auto file = Write("transforms.json", TransformsText(world_, "../room"));
  std::vector<Finding> findings;
  EXPECT_EQ(ReadNerfstudioCamera(file, &findings),
            (LensCamera{TestCamera(), world_.image_distortion}));
  const std::vector<NamedPose> poses = ReadNerfstudioPoses(file, &findings);
  EXPECT_TRUE(findings.empty());
  ASSERT_EQ(poses.size(), 2u) << "the third frame has no image";
  for (size_t i = 0; i < poses.size(); ++i) {
    const Rigid3d& expected = world_.frames[i].world_from_camera;
    EXPECT_EQ(poses[i].image, "../room/" + world_.frames[i].image);
    EXPECT_EQ(poses[i].world_from_camera.translation, expected.translation);
    EXPECT_LT(poses[i].world_from_camera.rotation.angularDistance(expected.rotation), 1e-7);
  }
}

// A camera that looks along the world's y axis: its image's right is x, its up is z, and its back
// is -y.
TEST_F(TransformsTest, AxesOfTheCameraAreRightUpAndBack) {
  Eigen::Matrix3d world_from_camera;
  world_from_camera.col(0) = Eigen::Vector3d::UnitX();
  world_from_camera.col(1) = -Eigen::Vector3d::UnitZ();
  world_from_camera.col(2) = Eigen::Vector3d::UnitY();
  for (WorldFrame& frame : world_.frames) {
    frame.camera = {640, 480, 500, 510, 319.5, 239.5};
    frame.world_from_camera = {Eigen::Quaterniond(world_from_camera), {1.0, 2.0, 3.0}};
  }
  const json document = json::parse(TransformsText(world_, ""));
  const auto rows = document.at("frames").at(0).at("transform_matrix");
  const std::vector<std::vector<double>> expected = {
      {1, 0, 0, 1}, {0, 0, -1, 2}, {0, 1, 0, 3}, {0, 0, 0, 1}};
  for (size_t i = 0; i < 4; ++i) {
    for (size_t k = 0; k < 4; ++k) EXPECT_NEAR(rows[i][k].get<double>(), expected[i][k], 1e-12);
  }
  EXPECT_EQ(document["frames"][1].at("file_path"), "rgb/b.png");
  EXPECT_EQ(document.at("cx"), 320.0);
  EXPECT_EQ(document.at("cy"), 240.0);
  EXPECT_EQ(document.at("k1"), 0.0);
  EXPECT_FALSE(document.contains("applied_transform"));
}

TEST_F(TransformsTest, FramesHaveCamerasOfTheirOwnWhereTheyDiffer) {
  world_.frames[1].camera.fx = 600.0;
  const json document = json::parse(TransformsText(world_, ""));
  EXPECT_FALSE(document.contains("fl_x"));
  EXPECT_EQ(document.at("frames").at(0).at("fl_x"), TestCamera().fx);
  EXPECT_EQ(document.at("frames").at(1).at("fl_x"), 600.0);
}

TEST_F(TransformsTest, LensesThatNerfstudioDoesNotKnowAreRefused) {
  world_.image_distortion = Distortion{.k4 = 0.1};
  ExpectError<InputError>([&] { TransformsText(world_, ""); }, {"k4", "nerfstudio"});
}

}  // namespace
}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "soslam/base/error.h"
#include "soslam/dataset/dataset_content.h"
#include "support/imported_folder.h"

namespace soslam {
namespace {

class SlamSyntheticTest : public ImportedFolderTest {
 protected:
  SlamSyntheticTest() {
    options_.format = DatasetFormat::kSlamSynthetic;
    Write("A.json", Problem("0.5"));
    Write("B.json", Problem("0.7"));
  }

  // Three frames and one object, the first dead reckoning with this x.
  static std::string Problem(const std::string& x) {
    const auto pose = [](const std::string& tx) {
      return "[[1,0,0," + tx + "],[0,1,0,0],[0,0,1,2],[0,0,0,1]]";
    };
    return R"({"camera": {"fx": 500, "fy": 500, "cx": 320, "cy": 240, "width": 640, "height": 480},
               "support_plane_world": [0, 0, 2, -1],
               "objects": [{"center": [1, 2, 3], "half": [0.1, 0.2, 0.3], "yaw": 0.5}],
               "T_wc": [)" +
           pose("0") + "," + pose("1") + "," + pose("2") + R"(], "init_T_wc": [)" + pose(x) + "," +
           pose("1.1") + "," + pose("2.2") + R"(], "boxes": [
               {"frame": 0, "object": 0, "box": [100, 100, 200, 200]},
               {"frame": 1, "object": 0, "box": [101, 100, 201, 200]},
               {"frame": 2, "object": 0, "box": [102, 100, 202, 200]}]})";
  }
};

TEST_F(SlamSyntheticTest, AProblemIsASegment) {
  const Sequence sequence = Import();
  ASSERT_EQ(sequence.frames.size(), 6u);
  EXPECT_EQ(sequence.frames[0].world_from_camera.translation, Eigen::Vector3d(0.5, 0, 2));
  EXPECT_EQ(sequence.frames[1].true_world_from_camera->translation, Eigen::Vector3d(1, 0, 2));
  EXPECT_EQ(sequence.frames[3].segment, 1);
  EXPECT_EQ(sequence.frames[3].id, 10000);
  ASSERT_EQ(sequence.objects.size(), 2u);
  const Landmark& truth = sequence.objects[0].ground_truth->landmark_in_world;
  EXPECT_EQ(truth.Centre(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(truth.half_axes, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(truth.shape_exponents, kEllipsoidExponent);
  EXPECT_NEAR(truth.frame_from_object.rotation.angularDistance(
                  Eigen::Quaterniond(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()))),
              0.0, 1e-12);
  EXPECT_EQ(sequence.planes[1].plane_in_world.offset, -0.5);
  EXPECT_EQ(sequence.detections.size(), 6u);
}

TEST_F(SlamSyntheticTest, ProblemsAreChosenByName) {
  options_.kitti.sequences = "B";
  options_.trajectory = TrajectorySource::kGroundTruth;
  const Sequence sequence = Import();
  ASSERT_EQ(sequence.frames.size(), 3u);
  EXPECT_EQ(sequence.frames[0].id, 10000);  // whatever else is chosen
  EXPECT_EQ(sequence.frames[0].world_from_camera.translation.x(), 0.0);
  options_.kitti.sequences = "B C";
  ExpectRefused<SettingsError>({"sequences", "'C'"});
}

TEST_F(SlamSyntheticTest, BadInputIsRefused) {
  const auto refused = [&](const std::string& from, const std::string& to,
                           const std::vector<std::string>& words) {
    std::string text = Problem("0.5");
    Write("A.json", text.replace(text.find(from), from.size(), to));
    ExpectRefused(words);
  };
  refused("\"object\": 0", "\"object\": 1", {"A.json#/boxes/0", "object is 1", "0 to 0"});
  refused("[[1,0,0,0]", "[[2,0,0,0]", {"A.json#/T_wc/0", "not orthonormal"});
  refused("[[1,0,0,0]", "[[0,0,0]", {"A.json#/T_wc/0", "4 rows of 4 numbers"});
  refused("\"half\": [0.1", "\"half\": [0", {"A.json#/objects/0", "half"});
}

}  // namespace
}  // namespace soslam

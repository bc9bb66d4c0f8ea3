// SPDX-License-Identifier: BSD-3-Clause
// The readers against files as their publishers made them, where these are present. The expected
// counts were taken with a few lines of another language.
#include <gtest/gtest.h>

#include <set>

#include "dataset/coco_labels.h"
#include "dataset/kitti_boxes.h"
#include "dataset/kitti_trajectory.h"
#include "dataset/oa_slam_boxes.h"
#include "dataset/yolo_boxes.h"
#include "geometry/distortion.h"
#include "support/real_data.h"
#include "support/run_command.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

size_t CountImages(const std::vector<LabelledBox>& boxes) {
  std::set<FrameKey> images;
  for (const LabelledBox& box : boxes) images.insert(box.frame);
  return images.size();
}

TEST(PublishedFilesTest, OaSlamBoxesOfADistortingCamera) {
  const fs::path file = RealDataset("fr2_desk") / "detections_yolov5_tum_rgbd_fr2_desk.json";
  if (!fs::exists(file)) GTEST_SKIP() << file << " is not there";
  const auto boxes = ReadOaSlamBoxes(file, CocoLabels());
  EXPECT_EQ(boxes.size(), 34331u);
  EXPECT_EQ(CountImages(boxes), 2965u);
  const Camera camera = {640, 480, 520.908620, 521.007327, 325.141442, 249.701764};
  const Distortion lens = {0.231222, -0.784899, -0.003257, -0.000105, 0.917205};
  for (size_t i = 0; i < boxes.size(); i += 10) {
    EXPECT_TRUE(UndistortBox(camera, lens, boxes[i].box)) << boxes[i].place;
  }
}

TEST(PublishedFilesTest, YoloBoxesInPixels) {
  const fs::path archive = RealDataset("fr3_long_office") / "yolo_txts.tar.gz";
  if (!fs::exists(archive)) GTEST_SKIP() << archive << " is not there";
  const TemporaryFolder folder;
  const auto unpacked = RunCommand({"tar", "xzf", archive.string(), "-C", folder.path().string()});
  ASSERT_EQ(unpacked.exit_code, 0) << unpacked.errors;
  const auto boxes = ReadPixelYoloBoxes(folder / "yolo_txts", CocoLabels());
  EXPECT_EQ(boxes.size(), 17225u);
  EXPECT_EQ(CountImages(boxes), 2585u);
}

TEST(PublishedFilesTest, KittiBoxes) {
  const fs::path folder = RealDataset("kitti_tracking") / "det_02_rrc";
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not there";
  size_t boxes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) boxes += ReadKittiBoxes(entry.path()).size();
  }
  EXPECT_EQ(boxes, 20630u);
}

TEST(PublishedFilesTest, KittiTrajectories) {
  const fs::path folder = RealDataset("kitti_tracking") / "poses_orbslam3_stereo";
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not there";
  size_t poses = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    poses += ReadKittiTrajectory(entry.path()).size();
  }
  EXPECT_EQ(poses, 4937u);
}

}  // namespace
}  // namespace soslam

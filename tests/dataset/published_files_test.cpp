// SPDX-License-Identifier: BSD-3-Clause
// The readers against files as their publishers made them, where these are present. The expected
// counts were taken with a few lines of another language.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "base/options.h"
#include "dataset/class_names.h"
#include "dataset/import.h"
#include "dataset/kitti_object.h"
#include "dataset/labelled_box.h"
#include "dataset/trajectories.h"
#include "dataset/yolo_boxes.h"
#include "geometry/distortion.h"
#include "support/real_data.h"

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
  const auto boxes = ReadPixelYoloBoxes(ReadYoloTexts(archive), CocoLabels());
  EXPECT_EQ(boxes.size(), 17225u);
  EXPECT_EQ(CountImages(boxes), 2585u);
}

// A whole folder, with the settings that the project has for it.
Sequence ImportWithItsSettings(const std::string& name) {
  std::ifstream file(fs::path(SOSLAM_SOURCE_DIR) / "pipelines/datasets" / (name + ".json"));
  ImportOptions options;
  OptionsFromJson(nlohmann::json::parse(file).at("import"), name, &options);
  options.frame_stride = 1;
  options.min_score = 0.0;
  options.border_px = 0.0;
  options.held_out = HeldOutFrames::kNone;
  return ImportDataset(RealDataset(name), options);
}

TEST(PublishedFilesTest, FolderOfFreiburg2Desk) {
  if (!fs::exists(RealDataset("fr2_desk"))) GTEST_SKIP() << "fr2_desk is not there";
  const Sequence sequence = ImportWithItsSettings("fr2_desk");
  EXPECT_TRUE(sequence.image_distortion);
  EXPECT_TRUE(sequence.planes.empty());
  EXPECT_GT(sequence.frames.size(), 2100u);  // of 2893 listed ones: motion capture has gaps
  EXPECT_LT(sequence.frames.size(), 2300u);
  EXPECT_GT(sequence.detections.size(), 20000u);
  EXPECT_EQ(sequence.rejected_detections.count("beyond_lens_model"), 0u);
}

TEST(PublishedFilesTest, FolderOfFreiburg3LongOffice) {
  if (!fs::exists(RealDataset("fr3_long_office"))) GTEST_SKIP() << "fr3_long_office is not there";
  const Sequence sequence = ImportWithItsSettings("fr3_long_office");
  EXPECT_FALSE(sequence.image_distortion);
  EXPECT_EQ(sequence.frames.size(), 2486u);
  EXPECT_GT(sequence.detections.size(), 16000u);
}

}  // namespace
}  // namespace soslam

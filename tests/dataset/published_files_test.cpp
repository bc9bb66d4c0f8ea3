// SPDX-License-Identifier: BSD-3-Clause
// The readers against files as their publishers made them, where these are present. The expected
// counts are those of their READMEs, or were taken with a few lines of another language.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "base/options.h"
#include "dataset/class_names.h"
#include "dataset/dataset_content.h"
#include "dataset/yolo_boxes.h"
#include "support/real_data.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

class PublishedFilesTest : public testing::Test {
 protected:
  // False, and the test is skipped, where the dataset is not there.
  bool Has(const std::string& name, const std::string& file = "") {
    folder_ = RealDataset(name);
    if (fs::exists(folder_ / file)) return true;
    Skip();
    return false;
  }

  Sequence Import(DatasetFormat format) {
    options_.format = format;
    options_.border_px = 0.0;
    return ImportDataset(folder_, options_);
  }

  // All frames and boxes, with the settings that the project has for the folder.
  Sequence ImportAllWithItsSettings() {
    fs::path name = folder_.filename();
    std::ifstream file(SOSLAM_SOURCE_DIR / fs::path("pipelines/datasets") / (name += ".json"));
    OptionsFromJson(nlohmann::json::parse(file).at("import"), name.string(), &options_);
    options_.frame_stride = 1;
    options_.min_score = 0.0;
    options_.held_out = HeldOutFrames::kNone;
    return Import(options_.format);
  }

  void SelectCars() {
    options_.min_observations = 1;
    options_.labels = "car";
  }

  fs::path folder_;
  ImportOptions options_;

 private:
  void Skip() { GTEST_SKIP() << folder_ << " is not there"; }
};

TEST_F(PublishedFilesTest, OaSlamBoxesOfADistortingCamera) {
  const std::string name = "detections_yolov5_tum_rgbd_fr2_desk.json";
  if (!Has("fr2_desk", name)) return;
  EXPECT_EQ(ReadOaSlamBoxes(folder_ / name, CocoLabels()).size(), 34331u);
}

TEST_F(PublishedFilesTest, YoloBoxesInPixels) {
  if (!Has("fr3_long_office", "yolo_txts.tar.gz")) return;
  const auto texts = ReadYoloTexts(folder_ / "yolo_txts.tar.gz");
  EXPECT_EQ(ReadPixelYoloBoxes(texts, CocoLabels()).size(), 17225u);
}

TEST_F(PublishedFilesTest, FolderOfFreiburg2Desk) {
  if (!Has("fr2_desk")) return;
  const Sequence sequence = ImportAllWithItsSettings();
  EXPECT_TRUE(sequence.image_distortion);
  EXPECT_GT(sequence.frames.size(), 2100u);  // of 2893 listed ones: motion capture has gaps
  EXPECT_LT(sequence.frames.size(), 2300u);
  EXPECT_GT(sequence.detections.size(), 20000u);
  EXPECT_EQ(sequence.rejected_detections.count("beyond_lens_model"), 0u);
}

TEST_F(PublishedFilesTest, FolderOfFreiburg3LongOffice) {
  if (!Has("fr3_long_office")) return;
  const Sequence sequence = ImportAllWithItsSettings();
  EXPECT_FALSE(sequence.image_distortion);
  EXPECT_EQ(sequence.frames.size(), 2486u);
  EXPECT_GT(sequence.detections.size(), 16000u);
}

TEST_F(PublishedFilesTest, FolderOfKittiObject) {
  if (!Has("kitti_object")) return;
  SelectCars();
  const Sequence sequence = Import(DatasetFormat::kKittiObject);
  EXPECT_EQ(sequence.frames.size(), 23u);
  EXPECT_EQ(sequence.detections.size(), 54u);
  for (const Frame& frame : sequence.frames) EXPECT_FALSE(frame.image.empty());
}

TEST_F(PublishedFilesTest, FolderOfKittiTracking) {
  if (!Has("kitti_tracking")) return;
  SelectCars();
  options_.max_truncation = 0.0;
  options_.max_occlusion = 0;
  options_.kitti.poses = "poses_orbslam3_stereo";
  options_.kitti.translation_scale = "1";  // as its README counts parked cars
  const Sequence sequence = Import(DatasetFormat::kKittiTracking);
  EXPECT_EQ(sequence.frames.size(), 4937u);
  EXPECT_EQ(sequence.objects.size(), 574u);
  EXPECT_EQ(sequence.detections.size(), 7459u);
  const auto parked = std::ranges::count_if(sequence.objects, [](const Object& object) {
    return object.label == "car" && object.is_static;
  });
  EXPECT_NEAR(static_cast<double>(parked), 263, 5);
}

TEST_F(PublishedFilesTest, FolderOfSlamSynthetic) {
  if (!Has("slam_synthetic")) return;
  const Sequence sequence = Import(DatasetFormat::kSlamSynthetic);
  EXPECT_EQ(sequence.frames.size(), 300u);
  EXPECT_EQ(sequence.objects.size(), 50u);
  EXPECT_EQ(sequence.detections.size(), 949u + 6495u);
}

}  // namespace
}  // namespace soslam

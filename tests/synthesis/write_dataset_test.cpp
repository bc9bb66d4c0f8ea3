// SPDX-License-Identifier: BSD-3-Clause

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <opencv2/imgcodecs.hpp>

#include "soslam/base/error.h"
#include "soslam/dataset/dataset_content.h"
#include "soslam/synthesis/simulate.h"
#include "support/scene.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

Scene SmallScene() {
  Scene scene = RandomScene(3, 3, 4);
  // A quarter of the size, the same view.
  scene.camera = {160, 120, 130.0, 130.0, 79.5, 59.5};
  scene.noise = {0.02, 0.3, 0.1, 0.02, 0.01, 0.5, 2.0};
  return scene;
}

std::map<std::string, std::string> Contents(const fs::path& folder) {
  std::map<std::string, std::string> contents;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) {
      contents[fs::relative(entry.path(), folder).string()] = FileBytes(entry.path());
    }
  }
  return contents;
}

class WriteDatasetTest : public testing::Test {
 protected:
  TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path() / "dataset";
};

TEST_F(WriteDatasetTest, WritesEveryFileAndNothingElse) {
  fs::create_directory(folder_);
  WriteDataset(SmallScene(), true, folder_, 1);
  std::vector<std::string> names;
  for (const auto& [name, bytes] : Contents(folder_)) names.push_back(name);
  EXPECT_THAT(names,
              testing::UnorderedElementsAre(
                  "README.md", "SHA256SUMS", "rgb.txt", "groundtruth.txt", "odometry.txt",
                  "camera.json", "planes.json", "objects.json", "detections.csv", "boxes_exact.csv",
                  "rgb/000000.png", "rgb/000001.png", "rgb/000002.png", "rgb/000003.png"));
  EXPECT_EQ(std::distance(fs::directory_iterator(temporary_.path()), {}), 1)
      << "no temporary is left beside it";
  const cv::Mat image = cv::imread((folder_ / "rgb/000002.png").string(), cv::IMREAD_UNCHANGED);
  EXPECT_EQ(image.size(), cv::Size(160, 120));
  EXPECT_EQ(image.type(), CV_8UC3);
}

TEST_F(WriteDatasetTest, ImportGivesTheSyntheticSequence) {
  const Scene scene = SmallScene();
  const Sequence synthetic = SyntheticSequence(scene, true);
  WriteDataset(scene, true, folder_, 1);
  ImportOptions options;
  options.border_px = 0.0;
  options.min_observations = 1;
  const Sequence imported = ImportDataset(folder_, options);
  ASSERT_EQ(imported.frames.size(), synthetic.frames.size());
  for (size_t i = 0; i < imported.frames.size(); ++i) {
    EXPECT_EQ(imported.frames[i].image, synthetic.frames[i].image);
    EXPECT_EQ(imported.frames[i].timestamp, synthetic.frames[i].timestamp);
    // Quaternions may be normalised once more on reading.
    EXPECT_TRUE(imported.frames[i].world_from_camera.Matrix().isApprox(
        synthetic.frames[i].world_from_camera.Matrix(), 1e-14));
    EXPECT_TRUE(imported.frames[i].true_world_from_camera->Matrix().isApprox(
        synthetic.frames[i].true_world_from_camera->Matrix(), 1e-14));
  }
  ASSERT_EQ(imported.objects.size(), synthetic.objects.size());
  for (size_t i = 0; i < imported.objects.size(); ++i) {
    EXPECT_EQ(imported.objects[i].id, synthetic.objects[i].id);
    EXPECT_EQ(imported.objects[i].label, synthetic.objects[i].label);
    EXPECT_TRUE(
        DualQuadric(imported.objects[i].ground_truth->landmark_in_world)
            .isApprox(DualQuadric(synthetic.objects[i].ground_truth->landmark_in_world), 1e-13));
  }
  ASSERT_EQ(imported.detections.size(), synthetic.detections.size());
  for (size_t i = 0; i < imported.detections.size(); ++i) {
    const Detection &read = imported.detections[i], &made = synthetic.detections[i];
    EXPECT_EQ(read.frame_index, made.frame_index);
    EXPECT_EQ(read.object_index, made.object_index);
    EXPECT_EQ(read.box.x_min, made.box.x_min);
    EXPECT_EQ(read.box.y_max, made.box.y_max);
    EXPECT_TRUE(
        read.plane_in_camera.Homogeneous().isApprox(made.plane_in_camera.Homogeneous(), 1e-13));
  }
}

// Boxes of visible parts, each with a false one.
Scene SceneWithFalseBoxes() {
  Scene scene = SmallScene();
  scene.boxes = BoxedPart::kVisible;
  scene.noise.false_share = 1.0;
  return scene;
}

TEST_F(WriteDatasetTest, FalseBoxesHaveNoObject) {
  const Scene scene = SceneWithFalseBoxes();
  const size_t true_boxes = SyntheticSequence(scene, true).detections.size();
  WriteDataset(scene, true, folder_, 1);
  ImportOptions options;
  options.border_px = 0.0;
  options.min_observations = 1;
  const Sequence with_ids = ImportDataset(folder_, options);
  EXPECT_EQ(with_ids.detections.size(), true_boxes);
  EXPECT_EQ(with_ids.rejected_detections.at("without_object_id"), static_cast<int>(true_boxes));

  std::string text = FileBytes(folder_ / "detections.csv");
  text.replace(text.find("object_id"), 9, "hidden_id");
  WriteBytes(folder_ / "detections.csv", text);
  const Sequence without_ids = ImportDataset(folder_, options);
  EXPECT_EQ(without_ids.detections.size(), 2 * true_boxes);
  for (const Detection& detection : without_ids.detections) {
    EXPECT_GE(detection.score, 0.25);
    EXPECT_LE(detection.score, 0.95);
  }
}

TEST_F(WriteDatasetTest, FalseAndVisibleBoxesAreTheSameForAnyNumberOfThreads) {
  WriteDataset(SceneWithFalseBoxes(), true, folder_, 1);
  const auto first = Contents(folder_);
  WriteDataset(SceneWithFalseBoxes(), true, folder_, 2);
  EXPECT_EQ(first, Contents(folder_));
}

// Also in place of a longer dataset, in a folder whose name ends with a slash.
TEST_F(WriteDatasetTest, SameBytesForAnyNumberOfThreads) {
  WriteDataset(SmallScene(), true, folder_, 1);
  const auto first = Contents(folder_);
  Scene longer = SmallScene();
  longer.trajectory.frames += 2;
  WriteDataset(longer, true, folder_, 1);
  WriteDataset(SmallScene(), true, folder_ / "", 4);
  EXPECT_EQ(first, Contents(folder_));
}

TEST_F(WriteDatasetTest, RefusesForeignFoldersAndFiles) {
  fs::create_directory(folder_);
  WriteBytes(folder_ / "thesis.tex", "years of work");
  EXPECT_THROW(WriteDataset(SmallScene(), true, folder_, 1), SettingsError);
  WriteBytes(folder_ / "README.md", "# My thesis\n");
  EXPECT_THROW(WriteDataset(SmallScene(), true, folder_, 1), SettingsError);
  EXPECT_EQ(FileBytes(folder_ / "thesis.tex"), "years of work");
  EXPECT_THROW(WriteDataset(SmallScene(), true, folder_ / "thesis.tex", 1), SettingsError);
  EXPECT_THROW(WriteDataset(SmallScene(), true, "/proc/nowhere/dataset", 1), SettingsError);
}

TEST_F(WriteDatasetTest, FailureLeavesTheEarlierDataset) {
  Scene scene = SmallScene();
  WriteDataset(scene, true, folder_, 1);
  const auto before = Contents(folder_);
  scene.trajectory.waypoints[0].look_at_in_world = scene.trajectory.waypoints[0].position_in_world;
  EXPECT_THROW(WriteDataset(scene, true, folder_, 1), InputError);
  EXPECT_EQ(before, Contents(folder_));
  EXPECT_EQ(std::distance(fs::directory_iterator(temporary_.path()), {}), 1);
}

}  // namespace
}  // namespace soslam

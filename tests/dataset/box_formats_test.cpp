// SPDX-License-Identifier: BSD-3-Clause
// Boxes in the formats of others, down to the imported sequence.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "dataset/dataset_content.h"
#include "support/expect_error.h"
#include "support/folder_formats_fixture.h"
#include "support/labelled_boxes.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

TEST_F(FolderFormatsTest, YoloInFractions) {
  Write("labels/1.0.txt", "41 0.5 0.25 0.125 0.5 0.75\n");
  const Detection detection = ImportOne(DetectionsFormat::kYolo, "labels");
  ExpectBox(detection.box, {279.5, -0.5, 359.5, 239.5});
  EXPECT_EQ(detection.score, 0.75);
  EXPECT_TRUE(detection.is_bound[1]);
}

TEST_F(FolderFormatsTest, YoloWithNamesAndTracks) {
  Write("labels/1.0.txt", "1 0.5 0.25 0.125 0.5 0.75 4\n1 0.2 0.2 0.1 0.1 0.5 -1\n");
  Write("labels/classes.txt", "book\ncup\n");
  options_.folder.detections_format = DetectionsFormat::kYolo;
  options_.detections = "labels";
  options_.min_observations = 1;
  std::vector<fs::path> files;
  testing::internal::CaptureStdout();
  const Sequence sequence = ImportDataset(folder_, options_, &files);
  EXPECT_THAT(
      testing::internal::GetCapturedStdout(),
      testing::AllOf(testing::HasSubstr("labels/classes.txt: names of 2 classes, book, cup"),
                     testing::HasSubstr("1 of 2 boxes have object_id -1")));
  ASSERT_EQ(sequence.objects.size(), 1u);
  EXPECT_EQ(sequence.objects[0].id, 4);
  EXPECT_EQ(sequence.objects[0].label, "cup");
  EXPECT_EQ(sequence.rejected_detections.at("without_object_id"), 1);
  EXPECT_EQ(std::ranges::count(files, folder_ / "labels/classes.txt"), 1);
}

TEST_F(FolderFormatsTest, YoloInPixelsFromAnArchiveAndWithoutAList) {
  Write("txts/2.0.txt", "0 100 110 20 30 0.6\n");
  Write("names.txt", "cup\n");
  PackTxts();
  options_.folder.class_names = "names.txt";
  options_.folder.images = "";
  const Detection detection = ImportOne(DetectionsFormat::kYoloPixels, "txts.tar.gz");
  ExpectBox(detection.box, {99.5, 109.5, 119.5, 139.5});
  EXPECT_EQ(Import().frames.at(0).world_from_camera.translation.x(), 0.1);
}

TEST_F(FolderFormatsTest, ClassNamesOfAnArchiveAreThoseThatAreKnown) {
  Write("txts/2.0.txt", "0 100 110 20 30 0.6\n");
  Write("txts/classes.txt", "mug\n");
  PackTxts();
  options_.folder.detections_format = DetectionsFormat::kYoloPixels;
  options_.detections = "txts.tar.gz";
  const DatasetContent content = ReadSoslamFolder(folder_, options_);
  EXPECT_THAT(content.class_names, testing::ElementsAre("mug"));
  EXPECT_FALSE(content.class_names_file);
}

TEST_F(FolderFormatsTest, CocoResults) {
  Write("results.json",
        R"([{"image_id": 1, "category_id": 47, "bbox": [10, 20, 30, 40], "score": 0.5}])");
  const Detection detection = ImportOne(DetectionsFormat::kCoco, "results.json");
  ExpectBox(detection.box, {9.5, 19.5, 39.5, 59.5});
  EXPECT_EQ(detection.frame_index, 1);
}

TEST_F(FolderFormatsTest, OaSlamWithImagesThatAreNotListed) {
  const std::string boxes = R"(, "detections": [
      {"category_id": 41, "detection_score": 0.9, "bbox": [10, 20, 30, 40]}]})";
  const std::string listed = R"({"file_name": "3.0.png")" + boxes;
  const std::string unlisted = R"({"file_name": "3.2.png")" + boxes;
  Write("oa.json", "[" + listed + "," + unlisted + "]");
  EXPECT_EQ(ImportOne(DetectionsFormat::kOaSlam, "oa.json").frame_index, 2);
  EXPECT_EQ(Import().rejected_detections.at("frame_not_listed"), 1);
  Write("oa.json", "[" + unlisted + "]");
  ExpectError<InputError>([&] { Import(); }, {"oa.json#/0", "3.2.png", "pairs.txt"});
}

TEST_F(FolderFormatsTest, KittiBoxesByClass) {
  Write("boxes/cup/0001.txt", "1,10,20,30,40,0.5\n");
  ExpectBox(ImportOne(DetectionsFormat::kKitti, "boxes").box, {10, 20, 30, 40});
  ExpectBox(ImportOne(DetectionsFormat::kKitti, "boxes/cup/0001.txt").box, {10, 20, 30, 40});
  Write("boxes/cup/0002.txt", "");
  options_.detections = "boxes";
  ExpectError<InputError>([&] { Import(); }, {"boxes/cup", "2 files"});
}

// A lens that pulls everything inwards: its images show more than a camera without it would see.
TEST_F(FolderFormatsTest, BoxesAreUndistorted) {
  Write("detections.csv",
        "frame,label,score,x1,y1,x2,y2\n0,cup,0.9,219.5,139.5,419.5,339.5\n"
        "1,cup,0.9,-0.5,100,150,200\n");
  options_.folder.distortion = "-0.2 0 0 0 0";
  const Sequence sequence = Import();
  EXPECT_EQ(sequence.image_distortion, Distortion{-0.2});
  // The middle of the left edge is at r = x = -0.2 where the lens has it: x' (1 - 0.2 x'^2) = x.
  // A corner is at (-0.2, -100 / 510): further out, so the box ends there.
  const Box& box = sequence.detections[0].box;
  const Eigen::Vector2d corner((box.x_min - 319.5) / 500, (box.y_min - 239.5) / 510);
  EXPECT_NEAR(corner.x() * (1 - 0.2 * corner.squaredNorm()), -0.2, 1e-6);
  EXPECT_NEAR(corner.y() * (1 - 0.2 * corner.squaredNorm()), -100.0 / 510, 1e-6);
  // Its edge is cut by the border of the file, wherever it is without the lens.
  EXPECT_LT(sequence.detections[1].box.x_min, -10.0);
  EXPECT_EQ(sequence.detections[1].is_bound, (std::array<bool, 4>{true, false, false, false}));
  EXPECT_EQ(sequence.detections[0].is_bound, (std::array<bool, 4>{}));
}

TEST_F(FolderFormatsTest, DistortionOfTheCameraFileHolds) {
  options_.folder.camera = "";
  Write("camera.json", R"({"width": 640, "height": 480, "fx": 500, "fy": 510, "cx": 319.5,
                           "cy": 239.5, "distortion": [-0.2, 0, 0, 0, 0]})");
  EXPECT_EQ(Import().image_distortion, Distortion{-0.2});
  options_.folder.distortion = "0 0 0 0 0";
  EXPECT_FALSE(Import().image_distortion);
}

TEST_F(FolderFormatsTest, BoxesWhereTheLensModelEndsAreCounted) {
  options_.folder.distortion = "-2 0 0 0 0";
  Write("detections.csv",
        "frame,label,score,x1,y1,x2,y2\n0,cup,1,300,220,340,260\n0,cup,1,10,10,50,50\n");
  const Sequence sequence = Import();
  EXPECT_EQ(sequence.detections.size(), 1u);
  EXPECT_EQ(sequence.rejected_detections.at("beyond_lens_model"), 1);
}

TEST_F(FolderFormatsTest, DamagedArchivesAreRefused) {
  Write("boxes.tar.gz", "this is no archive");
  options_.folder.detections_format = DetectionsFormat::kYolo;
  options_.detections = "boxes.tar.gz";
  ExpectError<InputError>([&] { Import(); }, {"boxes.tar.gz", "expected an archive"});
}

}  // namespace
}  // namespace soslam

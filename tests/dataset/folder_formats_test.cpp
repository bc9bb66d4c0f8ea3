// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "soslam/base/error.h"
#include "soslam/dataset/class_names.h"
#include "soslam/dataset/dataset_content.h"
#include "soslam/model/occlusion.h"
#include "support/imported_folder.h"
#include "support/labelled_boxes.h"
#include "support/lists.h"
#include "support/run_command.h"

namespace soslam {
// Folders of images in the formats of others, down to the imported sequence.
namespace {

// Four colour images, paired with depth images, of which the first is there; true poses that are
// 4 ms late, none near the last image; no planes, no object ids.
class FolderFormatsTest : public ImportedFolderTest {
 protected:
  FolderFormatsTest() {
    options_.format = DatasetFormat::kTumRgbd;
    options_.folder.images = "pairs.txt";
    options_.folder.camera = "640 480 500 510 319.5 239.5";
    options_.border_px = 0.0;
    Write("pairs.txt",
          "1.0 rgb/1.0.png 1.1 depth/1.1.png\n2.0 rgb/2.0.png 2.1 depth/2.1.png\n"
          "3.0 rgb/3.0.png 3.1 depth/3.1.png\n4.0 rgb/4.0.png 4.1 depth/4.1.png\n");
    Write("rgb/1.0.png", "an image");
    Write("groundtruth.txt",
          "1.004 0 0 1 0 0 0 1\n2.004 0.1 0 1 0 0 0 1\n3.004 0.2 0 1 0 0 0 1\n"
          "3.5 9 9 9 0 0 0 1\n");
    Write("detections.csv",
          "frame,label,score,x1,y1,x2,y2\n0,cup,0.9,100,100,200,200\n0,cup,0.8,300,100,400,200\n"
          "1,book,0.9,101,100,201,200\n3,cup,0.9,103,100,203,200\n");
  }

  // Puts folder txts into the archive txts.tar.gz.
  void PackTxts() const {
    const std::string archive = (folder_ / "txts.tar.gz").string();
    EXPECT_EQ(RunCommand({"tar", "czf", archive, "-C", folder_.path().string(), "txts"}).exit_code,
              0);
    std::filesystem::remove_all(folder_ / "txts");
  }
  // Imports detections of this format, of which there has to be one.
  Detection ImportOne(DetectionsFormat format, const std::string& name) {
    options_.folder.detections_format = format;
    options_.detections = name;
    const Sequence sequence = Import();
    const Detection detection = Only(sequence.detections);
    EXPECT_EQ(sequence.ObjectOf(detection).label, "cup");
    return detection;
  }
};

namespace fs = std::filesystem;

TEST_F(FolderFormatsTest, TumRgbdWithoutPlanesAndIds) {
  const Sequence sequence = Import();
  EXPECT_EQ(sequence.camera, (Camera{640, 480, 500, 510, 319.5, 239.5}));
  ASSERT_EQ(sequence.frames.size(), 3u);  // the last image has no pose
  EXPECT_EQ(sequence.frames[0].image, "rgb/1.0.png");
  EXPECT_EQ(sequence.frames[1].image, "");
  EXPECT_EQ(sequence.frames[2].world_from_camera.translation.x(), 0.2);
  EXPECT_EQ(sequence.frames[2].true_world_from_camera->translation.x(), 0.2);
  EXPECT_TRUE(sequence.planes.empty());
  ASSERT_EQ(sequence.detections.size(), 3u);
  ASSERT_EQ(sequence.objects.size(), 3u);  // one for each detection that is used
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(sequence.detections[i].object_index, i);
    EXPECT_EQ(sequence.objects[i].plane_index, kNoPlane);
  }
  EXPECT_EQ(sequence.rejected_detections.at("frame_without_pose"), 1);
}

TEST_F(FolderFormatsTest, FirstFrameAndStrideThinTheList) {
  options_.first_frame = 1;
  options_.frame_stride = 2;
  const Sequence sequence = Import();
  EXPECT_EQ(Only(sequence.frames).id, 1);
  EXPECT_EQ(sequence.rejected_detections.at("frame_not_used"), 2);
}

TEST_F(FolderFormatsTest, WithoutPlanesWhatEndsLowerIsNearer) {
  Write("detections.csv",
        "frame,label,score,x1,y1,x2,y2\n0,cup,0.9,100,100,200,200\n0,cup,0.8,90,120,210,240\n");
  const Sequence sequence = Import();
  EXPECT_EQ(Only(BoxesInFront(sequence, sequence.detections[0])).y_max, 240.0);
  EXPECT_TRUE(sequence.detections[0].is_one_sided[3]);
  EXPECT_TRUE(BoxesInFront(sequence, sequence.detections[1]).empty());
}

TEST_F(FolderFormatsTest, GivenPlanesHoldForDetectionsWithoutIds) {
  Write("planes.json", R"([{"id": 5, "normal": [0, 0, 1], "d": 0}])");
  const Sequence sequence = Import();
  EXPECT_EQ(sequence.planes.at(sequence.objects[0].plane_index).id, 5);
  EXPECT_EQ(sequence.detections[0].plane_in_camera.offset, 1.0);  // the camera is at height 1
}

TEST_F(FolderFormatsTest, BoxesWithoutIdsGetIdsAboveThoseOfTheListedObjects) {
  Write("objects.json", R"([{"id": 2147483640, "label": "cup"}])");
  EXPECT_EQ(Import().objects.back().id, 2147483643);
  Write("objects.json", R"([{"id": 2147483647, "label": "cup"}])");
  ExpectRefused({"above the 2147483647 of objects.json"});
  Write("detections.csv",
        "frame,object_id,label,score,x1,y1,x2,y2\n0,2147483647,cup,0.9,100,100,200,200\n"
        "1,2147483647,cup,0.9,100,100,200,200\n2,2147483647,cup,0.9,100,100,200,200\n");
  EXPECT_EQ(Only(Import().objects).id, 2147483647);
}

TEST_F(FolderFormatsTest, OdometryOfItsOwnWorldIsAligned) {
  Write("slam.txt", "1 5 0 0 0 0 0.70710678 0.70710678\n2 5 0.1 0 0 0 0.70710678 0.70710678\n");
  options_.folder.odometry = "slam.txt";
  EXPECT_EQ(Import().frames[1].world_from_camera.translation.x(), 5.0);
  options_.folder.align_odometry = true;
  const Sequence sequence = Import();
  // The camera goes 0.1 m to its right: in the true world along x, at height 1.
  EXPECT_TRUE(
      sequence.frames[1].world_from_camera.translation.isApprox(Eigen::Vector3d(0.1, 0, 1), 1e-6));
  options_.folder.odometry = "absent.txt";
  ExpectRefused({"absent.txt", "missing"});
}

TEST_F(FolderFormatsTest, KittiTrajectoriesAreInTheOrderOfTheList) {
  options_.folder.trajectory_format = TrajectoryFormat::kKitti;
  const std::string pose = "1 0 0 0.5 0 1 0 0 0 0 1 2\n";
  Write("groundtruth.txt", pose + pose + pose + pose);
  EXPECT_EQ(Import().frames[3].world_from_camera.translation.x(), 0.5);
  Write("groundtruth.txt", pose + pose);
  ExpectRefused({"groundtruth.txt", "has 2 poses", "expected 4"});
}

TEST_F(FolderFormatsTest, ColmapNamesItsImages) {
  options_.folder.camera = "";
  options_.folder.camera_file = "sparse/cameras.txt";
  options_.folder.groundtruth = "sparse/images.txt";
  options_.folder.trajectory_format = TrajectoryFormat::kColmap;
  Write("sparse/cameras.txt", "1 SIMPLE_RADIAL 640 480 500 320 240 0.1\n");
  Write("sparse/images.txt",
        "7 1 0 0 0 -4 0 0 1 rgb/2.0.png\n1 2 -1\n3 1 0 0 0 -5 0 0 1 3.0.png\n\n"
        "4 1 0 0 0 0 0 0 1 none.png\n\n");
  testing::internal::CaptureStdout();
  const Sequence sequence = Import();
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              testing::HasSubstr("images.txt: 2 of 4 images have a pose; 1 poses are of images"));
  ASSERT_EQ(sequence.frames.size(), 2u);
  EXPECT_EQ(sequence.frames[0].id, 1);
  EXPECT_EQ(sequence.frames[0].world_from_camera.translation.x(), 4.0);
  EXPECT_EQ(sequence.camera.cx, 319.5);
  EXPECT_EQ(sequence.image_distortion, Distortion{0.1});
  Write("sparse/images.txt", "7 1 0 0 0 -4 0 0 1 2.0.png\n\n8 1 0 0 0 -4 0 0 1 2.0.png\n\n");
  ExpectRefused({"images.txt:3", "second pose", "2.0.png"});
  Write("sparse/images.txt", "7 1 0 0 0 -4 0 0 1 none.png\n\n");
  ExpectRefused({"images.txt:1", "(none.png)", "those that are listed (", "renamed"});
}

TEST_F(FolderFormatsTest, GroundTruthMayHaveAFormatOfItsOwn) {
  options_.folder.odometry = "images.txt";
  options_.folder.trajectory_format = TrajectoryFormat::kColmap;
  options_.folder.groundtruth_format = TrajectoryFormat::kTum;
  Write("images.txt", "7 1 0 0 0 -4 0 0 1 rgb/2.0.png\n\n");
  const Frame frame = Only(Import().frames);
  EXPECT_EQ(frame.world_from_camera.translation.x(), 4.0);
  EXPECT_EQ(frame.true_world_from_camera->translation.x(), 0.1);
  options_.trajectory = TrajectorySource::kGroundTruth;
  EXPECT_EQ(Import().frames.at(1).world_from_camera.translation.x(), 0.1);
}

TEST_F(FolderFormatsTest, NerfstudioIsListTrajectoryAndCamera) {
  options_.folder.camera = "";
  options_.folder.images = options_.folder.groundtruth = options_.folder.camera_file =
      "transforms.json";
  options_.folder.trajectory_format = TrajectoryFormat::kNerfstudio;
  Write("transforms.json", R"({"w": 640, "h": 480, "fl_x": 500, "frames": [
      {"file_path": "rgb/1.0.png",
       "transform_matrix": [[1, 0, 0, 1], [0, 1, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]]},
      {"file_path": "rgb/2.0.png",
       "transform_matrix": [[1, 0, 0, 4], [0, 1, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]]}]})");
  Write("detections.csv", "frame,label,score,x1,y1,x2,y2\n1,cup,0.9,100,100,200,200\n");
  const Sequence sequence = Import();
  ASSERT_EQ(sequence.frames.size(), 2u);
  EXPECT_EQ(sequence.frames[0].image, "rgb/1.0.png");
  EXPECT_EQ(sequence.frames[1].timestamp, 1.0);
  EXPECT_TRUE((sequence.frames[1].world_from_camera * Eigen::Vector3d(0, 0, 1))
                  .isApprox(Eigen::Vector3d(4, 2, 2)));
  options_.folder.camera = "640 480 500 510 319.5 239.5";
  ExpectRefused<SettingsError>({"camera_file", "both"});
}

TEST_F(FolderFormatsTest, EurocsListOfImages) {
  options_.format = DatasetFormat::kSoslam;
  options_.folder.images = "cam0/data.csv";
  Write("cam0/data.csv", "#timestamp [ns],filename\r\n1000000000,1.png\r\n2000000000, 2.png\r\n");
  Write("detections.csv", "frame,label,score,x1,y1,x2,y2\n1,cup,0.9,100,100,200,200\n");
  EXPECT_EQ(Import().frames.at(1).image, "2.png");
  EXPECT_EQ(Import().frames.at(1).timestamp, 2.0);
  Write("cam0/data/1.png", "an image");
  EXPECT_EQ(Import().frames.at(1).image, "cam0/data/2.png");
  Write("cam0/data.csv", "1 rgb/a,1.png\n2 rgb/2.png\n");
  EXPECT_EQ(Import().frames.at(1).image, "rgb/2.png");
  Write("cam0/data.csv", "1.5,1.png\n");
  ExpectRefused({"data.csv:1", "timestamp is 1.5", "nanoseconds"});
  Write("cam0/data.csv", "1,5 1.png\n");
  ExpectRefused({"timestamp is '1,5'", "decimal point"});
}

TEST_F(FolderFormatsTest, EurocsBodyIsNotItsCamera) {
  options_.folder.groundtruth = "data.csv";
  options_.folder.trajectory_format = TrajectoryFormat::kEuroc;
  Write("data.csv",
        "# time\n1000000000,1,2,3,1,0,0,0\n2000000000,4,2,3,0.70710678,0,0,0.70710678\n");
  EXPECT_EQ(Import().frames.at(1).world_from_camera.translation, Eigen::Vector3d(4, 2, 3));
  options_.folder.camera = "";
  options_.folder.camera_file = "sensor.yaml";
  Write("sensor.yaml",
        "T_BS:\n  data: [1, 0, 0, 0.5, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1]\n"
        "resolution: [640, 480]\nintrinsics: [500, 510, 319.5, 239.5]\n");
  // The body is turned by 90 degrees about z, the camera in it by as much about x.
  const Rigid3d pose = Import().frames.at(1).world_from_camera;
  EXPECT_TRUE(pose.translation.isApprox(Eigen::Vector3d(4, 2.5, 3)));
  EXPECT_TRUE((pose * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(4, 3.5, 3)));
  EXPECT_TRUE((pose * Eigen::Vector3d(0, 1, 0)).isApprox(Eigen::Vector3d(4, 2.5, 4)));
  EXPECT_TRUE((pose * Eigen::Vector3d(0, 0, 1)).isApprox(Eigen::Vector3d(5, 2.5, 3)));
}

// A point 1 m right of, 1 m above and 4 m ahead of a camera with y up at (1, 2, 3).
TEST_F(FolderFormatsTest, IclNuimIsMirrored) {
  options_.format = DatasetFormat::kIclNuim;
  options_.folder.camera = "640 480 481.2 -480 319.5 239.5";
  Write("pairs.txt", "0 depth/0.png 0 rgb/0.png\n30 depth/30.png 30 rgb/30.png\n");
  Write("groundtruth.txt", "0 1 2 3 0 0 0 1\n30 1 2 3 0 0 0 1\n");
  Write("rgb/0.png", "an image");
  Write("detections.csv", "frame,label,score,x1,y1,x2,y2\n1,cup,1,100,100,200,200\n");
  const Sequence sequence = Import();
  EXPECT_EQ(sequence.frames[0].image, "rgb/0.png");
  EXPECT_EQ(sequence.frames[1].timestamp, 1.0);
  EXPECT_EQ(sequence.frames[0].world_from_camera.translation, Eigen::Vector3d(1, -2, 3));
  const auto pixel = sequence.camera.Project({1, -1, 4});
  EXPECT_EQ(*pixel, Eigen::Vector2d(319.5 + 481.2 / 4, 239.5 - 480.0 / 4));
  Write("pairs.txt", "0.5 rgb/0.png\n");
  ExpectRefused({"pairs.txt", "0.5", "number of a frame"});
  options_.folder.camera = "640 480 481.2 480 319.5 239.5";
  ExpectRefused<SettingsError>({"camera", "below 0"});
}

TEST_F(FolderFormatsTest, SettingsThatCannotBeAreRefused) {
  options_.folder.camera = "640 480 500";
  ExpectRefused<SettingsError>({"camera", "'640 480 500'", "fx fy cx cy"});
  options_.folder.camera = "640.5 480 500 500 320 240";
  ExpectRefused<SettingsError>({"camera", "640.5"});
  options_.folder.camera = "640 480 500 500 320 240";
  options_.folder.distortion = "0.1 0 0";
  ExpectRefused<SettingsError>({"distortion", "4, 8, 12 or 14"});
  options_.folder.distortion = "0.1 k2 0 0 0";
  ExpectRefused<SettingsError>({"distortion", "k1 k2 p1 p2 k3"});
}

TEST_F(FolderFormatsTest, AllThatIsMissingIsNamedAtOnce) {
  const fs::path empty = folder_ / "empty";
  fs::create_directories(empty);
  ExpectError<InputError>([&] { ImportDataset(empty, {}); },
                          {"rgb.txt", "camera.json", "detections.csv", "groundtruth.txt",
                           "are missing", "format soslam"});
}

}  // namespace

// Boxes in the formats of others, down to the imported sequence.
namespace {

TEST_F(FolderFormatsTest, YoloInFractions) {
  Write("labels/1.0.txt", "41 0.5 0.25 0.125 0.5 0.75\n");
  const Detection detection = ImportOne(DetectionsFormat::kYolo, "labels");
  ExpectBox(detection.box, {279.5, -0.5, 359.5, 239.5});
  EXPECT_EQ(detection.score, 0.75);
  EXPECT_TRUE(detection.is_one_sided[1]);
}

TEST_F(FolderFormatsTest, YoloWithNamesAndTracks) {
  Write("labels/1.0.txt", "1 0.5 0.25 0.125 0.5 0.75 4\n1 0.2 0.2 0.1 0.1 0.5 -1\n");
  Write("labels/classes.txt", "book\ncup\n");
  options_.folder.detections_format = DetectionsFormat::kYolo;
  options_.detections = "labels";
  options_.min_observations = 1;
  std::vector<fs::path> files;
  testing::internal::CaptureStdout();
  const Sequence sequence = ImportDataset(folder_.path(), options_, &files);
  EXPECT_THAT(
      testing::internal::GetCapturedStdout(),
      testing::AllOf(testing::HasSubstr("labels/classes.txt: names of 2 classes, book, cup"),
                     testing::HasSubstr("1 of 2 boxes have object_id -1")));
  const Object object = Only(sequence.objects);
  EXPECT_EQ(object.id, 4);
  EXPECT_EQ(object.label, "cup");
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

TEST_F(FolderFormatsTest, CocoResults) {
  Write("results.json",
        R"([{"image_id": 1, "category_id": 47, "bbox": [10, 20, 30, 40], "score": 0.5}])");
  const Detection detection = ImportOne(DetectionsFormat::kCoco, "results.json");
  ExpectBox(detection.box, {9.5, 19.5, 39.5, 59.5});
  EXPECT_EQ(detection.frame_index, 1);
}

// A data set whose only box is in a copy of the second image.
std::string DataSetOfCopies(int width, int height, const std::string& attributes = "{}") {
  return fmt::format(
      R"({{"images": [{{"id": 1, "file_name": "2.0_png.rf.0123456789abcdef.jpg", "width": {}, "height": {}}}],
           "categories": [{{"id": 3, "name": "cup"}}],
           "annotations": [{{"image_id": 1, "category_id": 3, "bbox": [100, 200, 30, 40],
                             "attributes": {}}}]}})",
      width, height, attributes);
}

TEST_F(FolderFormatsTest, CopiesOfAnnotationToolsHaveTheImagesSize) {
  Write("coco.json", DataSetOfCopies(640, 480));
  testing::internal::CaptureStdout();
  EXPECT_EQ(ImportOne(DetectionsFormat::kCoco, "coco.json").frame_index, 1);
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              testing::HasSubstr("coco.json: 1 images are found by names with another ending"));
  EXPECT_TRUE(Import().findings.empty());
  Write("coco.json", DataSetOfCopies(640, 640));
  ExpectRefused({"1 of 1 boxes are of images of 640 x 640 pixels", "640 x 480"});
  Write("coco.json", DataSetOfCopies(0, 0));
  EXPECT_TRUE(Import().findings.empty());
}

TEST_F(FolderFormatsTest, SizesOfImagesThatAreNotListedDoNotMatter) {
  auto boxes = nlohmann::json::parse(DataSetOfCopies(640, 480));
  boxes["images"].push_back({{"id", 2}, {"file_name", "x.png"}, {"width", 9}, {"height", 9}});
  boxes["annotations"].push_back({{"image_id", 2}, {"category_id", 3}, {"bbox", {1, 1, 5, 5}}});
  Write("coco.json", boxes.dump());
  ImportOne(DetectionsFormat::kCoco, "coco.json");
}

TEST_F(FolderFormatsTest, ObliqueBoxesAreAFinding) {
  Write("coco.json", DataSetOfCopies(640, 480, R"({"rotation": 90.0})"));
  ExpectBox(ImportOne(DetectionsFormat::kCoco, "coco.json").box, {94.5, 204.5, 134.5, 234.5});
  EXPECT_TRUE(Import().findings.empty());
  Write("coco.json", DataSetOfCopies(640, 480, R"({"rotation": 40.0})"));
  const Finding finding = Only(Import().findings);
  EXPECT_EQ(finding.check, "oblique_boxes");
  EXPECT_THAT(finding.found, testing::HasSubstr("coco.json: 1 of 1 boxes"));
}

TEST_F(FolderFormatsTest, BoxesOutOfViewAreCounted) {
  std::string boxes = DataSetOfCopies(640, 480);
  boxes.insert(boxes.rfind("]}"),
               R"(, {"image_id": 1, "category_id": 3, "bbox": [9, 9, 9, 9],
                     "attributes": {"outside": true}})");
  Write("coco.json", boxes);
  ImportOne(DetectionsFormat::kCoco, "coco.json");
  EXPECT_EQ(Import().rejected_detections.at("out_of_view"), 1);
}

TEST_F(FolderFormatsTest, FartherListsOfNamesMayNotContradictEither) {
  options_.folder.detections_format = DetectionsFormat::kYolo;
  options_.detections = "labels";
  Write("labels/1.0.txt", "1 0.5 0.25 0.125 0.5\n");
  Write("labels/classes.txt", "book\ncup\n");
  Write("data.yaml", "names: [book, Cup, bowl]\n");
  Write("dataset.yaml", "path: of another program\n");
  EXPECT_THAT(Import().findings, testing::IsEmpty());
  Write("obj.names", "this, that\n");
  const Finding finding = Only(Import().findings);
  EXPECT_THAT(finding.found, testing::HasSubstr("obj.names:1: label is 'this, that'"));
  EXPECT_THAT(finding.expected, testing::HasSubstr("labels/classes.txt"));
  Write("data.yaml", "names: [cup, book]\n");
  ExpectRefused({"class 0 is 'book', but 'cup' in", "data.yaml", "class_names"});
  options_.folder.class_names = "data.yaml";
  EXPECT_EQ(Only(Import().objects).label, "book");
}

TEST_F(FolderFormatsTest, ListsOfNamesInOneFolderMayNotContradictEachOther) {
  Write("txts/1.0.txt", "1 0.5 0.25 0.125 0.5\n");
  Write("txts/classes.txt", "book\ncup\n");
  Write("txts/obj.names", "cup\nbook\n");
  options_.folder.detections_format = DetectionsFormat::kYolo;
  options_.detections = "txts";
  const std::vector<std::string> words = {"txts/classes.txt: class 0 is 'book'", "'cup' in",
                                          "txts/obj.names", "class_names"};
  ExpectRefused(words);
  PackTxts();
  options_.detections = "txts.tar.gz";
  ExpectRefused(words);
}

TEST_F(FolderFormatsTest, NamesThatAreAssumedAreSaid) {
  Write("labels/1.0.txt", "41 0.5 0.25 0.125 0.5\n");
  Write("results.json",
        R"([{"image_id": 1, "category_id": 47, "bbox": [10, 20, 30, 40], "score": 0.5}])");
  Write("oa.json", R"([{"file_name": "1.0.png", "detections": [
      {"category_id": 41, "detection_score": 0.9, "bbox": [10, 20, 30, 40]}]}])");
  for (const auto& [format, file] : {std::pair(DetectionsFormat::kYolo, "labels"),
                                     {DetectionsFormat::kCoco, "results.json"},
                                     {DetectionsFormat::kOaSlam, "oa.json"}}) {
    testing::internal::CaptureStdout();
    ImportOne(format, file);
    EXPECT_THAT(
        testing::internal::GetCapturedStdout(),
        testing::HasSubstr(fmt::format("{}: has no names of its classes; takes COCO's 80, of "
                                       "which 1 occur, cup; class_names gives others",
                                       file)));
  }
  Write("labels/classes.txt", fmt::format("{}\n", fmt::join(CocoLabels(), "\n")));
  Write("coco.json", DataSetOfCopies(640, 480));
  for (const auto& [format, file] :
       {std::pair(DetectionsFormat::kYolo, "labels"), {DetectionsFormat::kCoco, "coco.json"}}) {
    testing::internal::CaptureStdout();
    ImportOne(format, file);
    EXPECT_THAT(testing::internal::GetCapturedStdout(),
                testing::Not(testing::HasSubstr("COCO's 80")));
  }
}

TEST_F(FolderFormatsTest, NumbersOfImagesThatAreNoRows) {
  const auto with_ids = [&](int first, int last) {
    Write("results.json",
          fmt::format(R"([{{"image_id": {}, "category_id": 47, "bbox": [10, 20, 30, 40]}},
                          {{"image_id": {}, "category_id": 47, "bbox": [10, 20, 30, 40]}}])",
                      first, last));
  };
  options_.folder.detections_format = DetectionsFormat::kCoco;
  options_.detections = "results.json";
  with_ids(1, 4);
  ExpectRefused({"results.json#/1", "frame is 4", "0 to 3", "counted from 1?", "class_names"});
  with_ids(0, 4);
  EXPECT_THAT(ExpectError<InputError>([&] { Import(); }, {"frame is 4", "class_names"}),
              testing::Not(testing::HasSubstr("from 1")));
  options_.folder.detections_format = DetectionsFormat::kCsv;
  options_.detections = "detections.csv";
  Write("detections.csv", "frame,label,x1,y1,x2,y2\n1,cup,1,2,3,4\n4,cup,1,2,3,4\n");
  EXPECT_THAT(ExpectError<InputError>([&] { Import(); }, {"detections.csv:3", "counted from 1?"}),
              testing::Not(testing::HasSubstr("class_names")));
}

TEST_F(FolderFormatsTest, ABoxTooManyInAnImageIsRefused) {
  std::string table = "frame,label,score,x1,y1,x2,y2\n0,cup,0.1,100,100,200,200\n";
  for (int i = 0; i < 1000; ++i) table += "0,cup,0.9,100,100,200,200\n";
  Write("detections.csv", table);
  ExpectRefused({"detections.csv:1002", "1001 boxes of image 0", "at most 1000", "min_score"});
  options_.min_score = 0.5;
  EXPECT_EQ(Import().detections.size(), 1000u);
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
  ExpectRefused({"oa.json#/0", "3.2.png", "pairs.txt"});
}

TEST_F(FolderFormatsTest, KittiBoxesByClass) {
  Write("boxes/cup/0001.txt", "1,10,20,30,40,0.5\n");
  ExpectBox(ImportOne(DetectionsFormat::kKitti, "boxes").box, {10, 20, 30, 40});
  ExpectBox(ImportOne(DetectionsFormat::kKitti, "boxes/cup/0001.txt").box, {10, 20, 30, 40});
  Write("boxes/cup/0002.txt", "");
  options_.detections = "boxes";
  ExpectRefused({"boxes/cup", "2 files"});
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
  EXPECT_EQ(sequence.detections[1].is_one_sided, (std::array<bool, 4>{true, false, false, false}));
  EXPECT_EQ(sequence.detections[0].is_one_sided, (std::array<bool, 4>{}));
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
  ExpectRefused({"boxes.tar.gz", "expected an archive"});
}

}  // namespace
}  // namespace soslam

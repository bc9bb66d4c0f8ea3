// SPDX-License-Identifier: BSD-3-Clause
// Folders of images in the formats of others, down to the imported sequence.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "model/occlusion.h"
#include "support/expect_error.h"
#include "support/folder_formats_fixture.h"

namespace soslam {
namespace {

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

TEST_F(FolderFormatsTest, SaysHowManyImagesHaveAPose) {
  testing::internal::CaptureStdout();
  Import();
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              testing::AllOf(testing::HasSubstr("3 of 4 images have a pose, at most 4.0 ms away"),
                             testing::HasSubstr("1 have none within 20 ms"),
                             testing::HasSubstr("3 of 4 image files are not there")));
  options_.max_time_difference_s = 0.003;
  ExpectError<InputError>([&] { Import(); },
                          {"0 of 4 images have a pose of", "max_time_difference_s"});
}

TEST_F(FolderFormatsTest, FirstFrameAndStrideThinTheList) {
  options_.first_frame = 1;
  options_.frame_stride = 2;
  const Sequence sequence = Import();
  ASSERT_EQ(sequence.frames.size(), 1u);
  EXPECT_EQ(sequence.frames[0].id, 1);
  EXPECT_EQ(sequence.rejected_detections.at("frame_not_used"), 2);
}

TEST_F(FolderFormatsTest, WithoutPlanesWhatEndsLowerIsNearer) {
  Write("detections.csv",
        "frame,label,score,x1,y1,x2,y2\n0,cup,0.9,100,100,200,200\n0,cup,0.8,90,120,210,240\n");
  const Sequence sequence = Import();
  const std::vector<Box> nearer = BoxesInFront(sequence, sequence.detections[0]);
  ASSERT_EQ(nearer.size(), 1u);
  EXPECT_EQ(nearer[0].y_max, 240.0);
  EXPECT_TRUE(sequence.detections[0].is_bound[3]);
  EXPECT_TRUE(BoxesInFront(sequence, sequence.detections[1]).empty());
}

TEST_F(FolderFormatsTest, GivenPlanesHoldForDetectionsWithoutIds) {
  Write("planes.json", R"([{"id": 5, "normal": [0, 0, 1], "d": 0}])");
  const Sequence sequence = Import();
  EXPECT_EQ(sequence.planes.at(sequence.objects[0].plane_index).id, 5);
  EXPECT_EQ(sequence.detections[0].plane_in_camera.offset, 1.0);  // the camera is at height 1
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
  ExpectError<InputError>([&] { Import(); }, {"absent.txt", "missing"});
}

TEST_F(FolderFormatsTest, KittiTrajectoriesAreInTheOrderOfTheList) {
  options_.folder.trajectory_format = TrajectoryFormat::kKitti;
  const std::string pose = "1 0 0 0.5 0 1 0 0 0 0 1 2\n";
  Write("groundtruth.txt", pose + pose + pose + pose);
  EXPECT_EQ(Import().frames[3].world_from_camera.translation.x(), 0.5);
  Write("groundtruth.txt", pose + pose);
  ExpectError<InputError>([&] { Import(); }, {"groundtruth.txt", "has 2 poses", "expected 4"});
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
  ExpectError<InputError>([&] { Import(); }, {"images.txt:3", "second pose", "2.0.png"});
  Write("sparse/images.txt", "7 1 0 0 0 -4 0 0 1 none.png\n\n");
  ExpectError<InputError>([&] { Import(); },
                          {"images.txt:1", "(none.png)", "those that are listed (", "renamed"});
}

TEST_F(FolderFormatsTest, GroundTruthMayHaveAFormatOfItsOwn) {
  options_.folder.odometry = "images.txt";
  options_.folder.trajectory_format = TrajectoryFormat::kColmap;
  options_.folder.groundtruth_format = TrajectoryFormat::kTum;
  Write("images.txt", "7 1 0 0 0 -4 0 0 1 rgb/2.0.png\n\n");
  const Sequence sequence = Import();
  ASSERT_EQ(sequence.frames.size(), 1u);
  EXPECT_EQ(sequence.frames[0].world_from_camera.translation.x(), 4.0);
  EXPECT_EQ(sequence.frames[0].true_world_from_camera->translation.x(), 0.1);
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
  ExpectError<SettingsError>([&] { Import(); }, {"camera_file", "both"});
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
  ExpectError<InputError>([&] { Import(); }, {"data.csv:1", "timestamp is 1.5", "nanoseconds"});
  Write("cam0/data.csv", "1,5 1.png\n");
  ExpectError<InputError>([&] { Import(); }, {"timestamp is '1,5'", "decimal point"});
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
  ExpectError<InputError>([&] { Import(); }, {"pairs.txt", "0.5", "number of a frame"});
  options_.folder.camera = "640 480 481.2 480 319.5 239.5";
  ExpectError<SettingsError>([&] { Import(); }, {"camera", "below 0"});
}

TEST_F(FolderFormatsTest, SettingsThatCannotBeAreRefused) {
  options_.folder.camera = "640 480 500";
  ExpectError<SettingsError>([&] { Import(); }, {"camera", "'640 480 500'", "fx fy cx cy"});
  options_.folder.camera = "640.5 480 500 500 320 240";
  ExpectError<SettingsError>([&] { Import(); }, {"camera", "640.5"});
  options_.folder.camera = "640 480 500 500 320 240";
  options_.folder.distortion = "0.1 0 0";
  ExpectError<SettingsError>([&] { Import(); }, {"distortion", "4, 8, 12 or 14"});
  options_.folder.distortion = "0.1 k2 0 0 0";
  ExpectError<SettingsError>([&] { Import(); }, {"distortion", "k1 k2 p1 p2 k3"});
}

TEST_F(FolderFormatsTest, BadListsAreRefused) {
  Write("pairs.txt", "1.0 rgb/1.0.png 1.1\n");
  ExpectError<InputError>([&] { Import(); }, {"pairs.txt:1", "3 words"});
  Write("pairs.txt", "1.0 ../1.0.png\n");
  ExpectError<InputError>([&] { Import(); }, {"../1.0.png", "inside the dataset folder"});
  options_.folder.images = "";
  ExpectError<InputError>([&] { Import(); }, {"detections.csv:2", "row 0", "a list of images"});
}

TEST_F(FolderFormatsTest, AllThatIsMissingIsNamedAtOnce) {
  const fs::path empty = folder_ / "empty";
  fs::create_directories(empty);
  ExpectError<InputError>([&] { ImportDataset(empty, {}); },
                          {"rgb.txt", "camera.json", "detections.csv", "groundtruth.txt",
                           "are missing", "format soslam"});
}

}  // namespace
}  // namespace soslam

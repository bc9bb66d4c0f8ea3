// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/dataset/nerfstudio.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "soslam/base/error.h"
#include "soslam/dataset/calibration_file.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/image_files.h"
#include "support/lists.h"

namespace soslam {
namespace {

using nlohmann::json;

class NerfstudioTest : public FolderTest {
 protected:
  std::filesystem::path WriteDocument() { return Write("transforms.json", document_.dump()); }
  LensCamera Camera() { return ReadCameraFile(WriteDocument(), &findings_).camera; }
  void ExpectRefused(const char* pointer, const json& value,
                     const std::vector<std::string>& words) {
    const json before = document_;
    document_[json::json_pointer(pointer)] = value;
    ExpectError<InputError>(
        [&] {
          Camera();
          ReadNerfstudioPoses(WriteDocument(), &findings_);
        },
        words);
    document_ = before;
  }

  // A camera at (1, 2, 3) whose OpenGL axes x, y, z are y, z, x of the world.
  json document_ = {
      {"camera_model", "OPENCV"},
      {"w", 640},
      {"h", 480.0},
      {"fl_x", 500.0},
      {"fl_y", 510.0},
      {"cx", 320.0},
      {"cy", 240.0},
      {"k1", 0.1},
      {"p2", -0.2},
      {"frames",
       {{{"file_path", "./images/a.jpg"},
         {"transform_matrix", {{0, 0, 1, 1}, {1, 0, 0, 2}, {0, 1, 0, 3}, {0, 0, 0, 1}}}}}}};
  std::vector<Finding> findings_;
};

TEST_F(NerfstudioTest, CameraCountsFromTheCorner) {
  const LensCamera read = Camera();
  EXPECT_EQ(read.camera, (soslam::Camera{640, 480, 500, 510, 319.5, 239.5}));
  EXPECT_EQ(read.distortion, (Distortion{0.1, 0, 0, -0.2}));
}

TEST_F(NerfstudioTest, WhatIsAbsentHasItsUsualValue) {
  for (const char* key : {"fl_x", "fl_y", "cx", "cy", "k1", "p2", "camera_model"}) {
    document_.erase(key);
  }
  document_["camera_angle_x"] = 2.0 * std::atan(0.8);  // half of the width over the focal length
  const LensCamera read = Camera();
  EXPECT_NEAR(read.camera.fx, 400.0, 1e-9);
  EXPECT_EQ(read.camera.fy, read.camera.fx);
  EXPECT_EQ(read.camera.cx, 319.5);
}

TEST_F(NerfstudioTest, PosesHaveOpenGlAxes) {
  const NamedPose named = Only(ReadNerfstudioPoses(WriteDocument(), &findings_));
  EXPECT_EQ(named.image, "./images/a.jpg");
  const Rigid3d& pose = named.world_from_camera;
  EXPECT_TRUE((pose * Eigen::Vector3d(0, 0, 5)).isApprox(Eigen::Vector3d(-4, 2, 3)));
  EXPECT_TRUE((pose * Eigen::Vector3d(0, 5, 0)).isApprox(Eigen::Vector3d(1, 2, -2)));
  EXPECT_TRUE((pose * Eigen::Vector3d(5, 0, 0)).isApprox(Eigen::Vector3d(1, 7, 3)));
}

// A turn of the world does not matter to anything.
TEST_F(NerfstudioTest, AnotherScaleIsAFinding) {
  document_["applied_transform"] = {{1, 0, 0, 0}, {0, 0, 1, 0}, {0, -1, 0, 0}};
  document_["applied_scale"] = 1.0;
  ReadNerfstudioPoses(WriteDocument(), &findings_);
  EXPECT_THAT(findings_, testing::IsEmpty());
  document_["applied_scale"] = 0.25;
  ReadNerfstudioPoses(WriteDocument(), &findings_);
  const Finding finding = Only(findings_);
  EXPECT_THAT(finding.found, testing::HasSubstr("transforms.json: applied_scale is 0.25"));
  EXPECT_THAT(finding.remedy, testing::HasSubstr("multiply translations by 4"));
}

TEST_F(NerfstudioTest, ImagesAreSortedByName) {
  document_["frames"] = {{{"file_path", "./images/b.jpg"}}, {{"file_path", "./images/a.jpg"}}};
  const auto images = ReadNerfstudioImages(WriteDocument());
  EXPECT_THAT(Fields(images, &ListedImage::image),
              testing::ElementsAre("./images/a.jpg", "./images/b.jpg"));
  EXPECT_EQ(images.back().timestamp, 1.0);
}

TEST_F(NerfstudioTest, BadFilesAreNamed) {
  ExpectRefused("/camera_model", "OPENCV_FISHEYE", {"transforms.json", "not supported"});
  ExpectRefused("/is_fisheye", true, {"'fisheye' is not supported"});
  ExpectRefused("/k4", 0.1, {"k4 is 0.1"});
  ExpectRefused("/k6", 0.1, {"k6 is 0.1"});
  ExpectRefused("/w", 640.5, {"w is 640.5", "pixels"});
  ExpectRefused("/h", 1e9, {"h is"});
  ExpectRefused("/fl_x", 0, {"fl_x is 0"});
  ExpectRefused("/frames", json::array(), {"frames is []"});
  ExpectRefused("/frames/0/fl_x", 0, {"transforms.json#/frames/0", "fl_x is 0"});
  ExpectRefused("/frames/0/transform_matrix", {{1, 0, 0, 1}}, {"#/frames/0", "4 rows"});
  ExpectRefused("/frames/0/transform_matrix/0/2", 2, {"#/frames/0", "not orthonormal"});
  ExpectRefused("/frames/0/transform_matrix/0/2", -1, {"#/frames/0", "determinant -1"});
  ExpectRefused("/frames/0/transform_matrix/3/0", 1, {"#/frames/0", "last row", "1 0 0 1"});
  ExpectRefused("/frames/0/file_path", "", {"#/frames/0", "file_path"});
  ExpectRefused("/applied_scale", 0, {"transforms.json", "applied_scale is 0"});
  for (const char* key : {"fl_x", "fl_y"}) document_.erase(key);
  ExpectRefused("/camera_angle_x", 60, {"camera_angle_x is 60", "radians"});
  document_.erase("w");
  document_.erase("h");
  ExpectRefused("/camera_angle_x", 0.5, {"transforms.json: w is missing", "images"});
}

// Points on a grid over the image are 196 px from its middle column (root mean square), so that
// focal lengths of 500 and 500.5 px displace them by 0.1 px from their mean.
TEST_F(NerfstudioTest, CamerasOfFrames) {
  document_["frames"].push_back(document_["frames"][0]);
  document_["frames"][1]["fl_x"] = 500.0;
  EXPECT_EQ(Camera().camera.fx, 500.0) << "that of all";
  EXPECT_THAT(findings_, testing::IsEmpty());
  for (const char* key : {"w", "h", "fl_x", "fl_y", "cx", "cy"}) {
    for (json& frame : document_["frames"]) frame[key] = document_[key];
    document_.erase(key);
  }
  EXPECT_EQ(Camera().camera, (soslam::Camera{640, 480, 500, 510, 319.5, 239.5}));
  EXPECT_THAT(findings_, testing::IsEmpty());
  document_["k1"] = 0.0;
  document_["p2"] = 0.0;
  document_["frames"][1]["fl_x"] = 500.5;
  EXPECT_EQ(Camera().camera.fx, 500.25);
  EXPECT_THAT(Only(findings_).found, testing::HasSubstr("by 0.10 px"));
  document_["frames"][1]["fl_x"] = 510.0;
  ExpectError<InputError>([&] { Camera(); },
                          {"transforms.json#/frames/", "another camera", "1.9 px"});
}

// Scenes of Blender have an angle of view, no size, and images without extension.
TEST_F(NerfstudioTest, AnAngleOfViewNeedsOnlyTheImages) {
  document_ = {{"camera_angle_x", 2.0 * std::atan(0.8)}, {"frames", document_["frames"]}};
  document_["frames"][0]["file_path"] = "./train/r_0";
  Write("train/r_0.png", EncodedImage(".png", cv::Mat::zeros(30, 40, CV_8UC3)));
  EXPECT_EQ(Camera().camera.width, 40);
  EXPECT_EQ(Camera().camera.height, 30);
  EXPECT_NEAR(Camera().camera.fx, 25.0, 1e-9);
  EXPECT_EQ(Camera().camera.cy, 14.5);
  EXPECT_EQ(Only(ReadNerfstudioImages(WriteDocument())).image, "./train/r_0.png");
  for (const std::string extension : {".jpg", ".jpeg", ".JPG"}) {
    document_["frames"][0]["file_path"] = "./train/photo" + extension.substr(1);
    Write("train/photo" + extension.substr(1) + extension,
          EncodedImage(".jpg", cv::Mat::zeros(60, 80, CV_8UC3)));
    EXPECT_EQ(Camera().camera.width, 80);
    EXPECT_EQ(Only(ReadNerfstudioImages(WriteDocument())).image,
              "./train/photo" + extension.substr(1) + extension);
  }
  document_["frames"][0]["file_path"] = "./train/none";
  EXPECT_EQ(Only(ReadNerfstudioImages(WriteDocument())).image, "./train/none.png");
}

}  // namespace
}  // namespace soslam

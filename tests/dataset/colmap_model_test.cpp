// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/colmap_model.h"

#include <gtest/gtest.h>

#include <functional>

#include "base/error.h"
#include "dataset/calibration_file.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

class ColmapModelTest : public testing::Test {
 protected:
  LensCamera Cameras(const std::string& lines) {
    WriteBytes(folder_ / "cameras.txt", "# Camera list\n" + lines);
    return ReadColmapCamera(folder_ / "cameras.txt");
  }
  std::vector<NamedPose> Images(const std::string& lines) {
    WriteBytes(folder_ / "images.txt", "# Image list\n" + lines);
    return ReadColmapPoses(folder_ / "images.txt");
  }
  TemporaryFolder folder_;
};

// COLMAP's principal point counts from the corner of the top-left pixel.
TEST_F(ColmapModelTest, ModelsOfCameras) {
  const Camera same{640, 480, 500, 500, 319.5, 239.5};
  const Camera different{640, 480, 500, 510, 319.5, 239.5};
  for (const auto& [line, camera, lens] :
       std::vector<std::tuple<const char*, Camera, std::optional<Distortion>>>{
           {"1 SIMPLE_PINHOLE 640 480 500 320 240", same, std::nullopt},
           {"1 PINHOLE 640 480 500 510 320 240", different, std::nullopt},
           {"1 SIMPLE_RADIAL 640 480 500 320 240 0.1", same, Distortion{0.1}},
           {"1 SIMPLE_RADIAL 640 480 500 320 240 0", same, std::nullopt},
           {"1 RADIAL 640 480 500 320 240 0.1 0.2", same, Distortion{0.1, 0.2}},
           {"1 OPENCV 640 480 500 510 320 240 1 2 3 4", different, Distortion{1, 2, 3, 4}},
           {"1 FULL_OPENCV 640 480 500 510 320 240 1 2 3 4 5 6 7 8", different,
            Distortion{1, 2, 3, 4, 5, 6, 7, 8}}}) {
    const LensCamera read = Cameras(line);
    EXPECT_EQ(read.camera, camera) << line;
    EXPECT_EQ(read.distortion, lens) << line;
  }
}

TEST_F(ColmapModelTest, CamerasThatAreNotReadAreNamed) {
  const auto refused = [&](const std::string& lines, const std::vector<std::string>& words) {
    ExpectError<InputError>([&] { Cameras(lines); }, words);
  };
  const std::string first = "1 PINHOLE 640 480 500 510 320 240\n";
  EXPECT_EQ(Cameras(first + "2" + first.substr(1)).camera.fy, 510);
  refused(first + "2 PINHOLE 640 480 500 511 320 240\n",
          {"cameras.txt:3", "another camera", "single_camera"});
  refused("1 OPENCV_FISHEYE 640 480 500 500 320 240 0 0 0 0\n",
          {"cameras.txt:2", "'OPENCV_FISHEYE' is not supported", "undistort"});
  refused("1 CUBIC 640 480 500 500 320 240\n", {"'CUBIC'"});
  refused("1 PINHOLE 640 480 500 320 240\n", {"3 parameters; expected 4 of PINHOLE"});
  refused("1 PINHOLE 640 0 500 500 320 240\n", {"above 0"});
  refused("", {"cameras.txt", "no camera"});
}

TEST_F(ColmapModelTest, BinaryModelsAreNamed) {
  for (const auto& read : std::vector<std::function<void(const std::filesystem::path&)>>{
           [](const auto& path) { ReadColmapPoses(path); },
           [](const auto& path) { ReadCameraFile(path); }}) {
    ExpectError<InputError>([&] { read(folder_ / "cameras.bin"); },
                            {"cameras.bin", "binary", "colmap model_converter", "TXT"});
  }
}

// A camera at (1, 2, 3) that looks along the world's x axis: its z is the world's x, its x the
// world's -y, its y the world's -z. camera_from_world is the quaternion of the inverse turn, and
// moves the camera's place to the origin.
TEST_F(ColmapModelTest, PosesAreInvertedAndPointsSkipped) {
  const auto poses = Images(
      "1 0.5 0.5 -0.5 0.5 2 3 -1 1 photos/a b.jpg\n"
      "10.5 20.5 -1 1.5 2.5 7\n"
      "2 1 0 0 0 -4 0 0 1 c.jpg\n"
      "\n"
      "3 1 0 0 0 0 0 0 1 d.jpg\n");
  ASSERT_EQ(poses.size(), 3u);
  EXPECT_EQ(poses[0].image, "photos/a b.jpg");
  EXPECT_EQ(poses[0].place, (folder_ / "images.txt").string() + ":2");
  EXPECT_TRUE(
      (poses[0].world_from_camera * Eigen::Vector3d::Zero()).isApprox(Eigen::Vector3d(1, 2, 3)));
  EXPECT_TRUE(
      (poses[0].world_from_camera * Eigen::Vector3d(0, 0, 5)).isApprox(Eigen::Vector3d(6, 2, 3)));
  EXPECT_TRUE(
      (poses[0].world_from_camera * Eigen::Vector3d(5, 0, 0)).isApprox(Eigen::Vector3d(1, -3, 3)));
  EXPECT_EQ(poses[1].image, "c.jpg");
  EXPECT_EQ(poses[1].world_from_camera.translation.x(), 4.0);
  EXPECT_EQ(poses[2].image, "d.jpg");
}

TEST_F(ColmapModelTest, BadPosesAreNamed) {
  const auto refused = [&](const std::string& lines, const std::vector<std::string>& words) {
    ExpectError<InputError>([&] { Images(lines); }, words);
  };
  refused("1 0.5 0.5 0.5 0.5 3 -1 2 a.jpg\n", {"images.txt:2", "9 words", "NAME"});
  refused("1 0.5 0.5 0.5 0.6 3 -1 2 1 a.jpg\n", {"images.txt:2", "norm"});
  refused("1 0.5 x 0.5 0.5 3 -1 2 1 a.jpg\n", {"images.txt:2", "QX is 'x'"});
  refused("a 1 0 0 0 0 0 0 1 a.jpg\n", {"IMAGE_ID"});
  refused("", {"images.txt", "no pose"});
}

}  // namespace
}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/dataset/colmap_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "soslam/base/error.h"
#include "soslam/dataset/calibration_file.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/printed.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

class ColmapModelTest : public FolderTest {
 protected:
  LensCamera Cameras(const std::string& lines) {
    findings_.clear();
    return ReadColmapCamera(Write("cameras.txt", "# Camera list\n" + lines), &findings_);
  }

  std::vector<Finding> findings_;
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
  const std::string first = "1 PINHOLE 640 480 500 510 320 240\n";
  EXPECT_EQ(Cameras(first + "2" + first.substr(1)).camera.fy, 510);
  ExpectBadTexts({{first + "2 PINHOLE 640 480 500 525 320 240\n",
                   {"another camera", "2.1 px", "single_camera"}},
                  {first + "2 PINHOLE 480 640 500 510 320 240\n", {":3", "480 x 640", "640 x 480"}},
                  {"1 OPENCV_FISHEYE 640 480 500 500 320 240 0 0 0 0\n",
                   {":2", "'OPENCV_FISHEYE' is not supported", "image_undistorter"}},
                  {"1 CUBIC 640 480 500 500 320 240\n", {"'CUBIC'"}},
                  {"1 PINHOLE 640 480 500 320 240\n", {"3 parameters; expected 4 of PINHOLE"}},
                  {"1 PINHOLE 640 0 500 500 320 240\n", {"above 0"}},
                  {"", {"no camera"}}},
                 "cameras.txt", [&](const std::string& lines) { Cameras(lines); });
}

// Points on a grid over the image are 245 px from its middle (root mean square), so that cameras of
// focal lengths 500 and 501 are each 0.24 px from their mean; lenses add 0.0005 r^3 / f^2.
TEST_F(ColmapModelTest, CamerasThatAreNearlyEqualAreOne) {
  EXPECT_EQ(Cameras("1 SIMPLE_RADIAL 640 480 500 320 240 0\n2 PINHOLE 640 480 500 500 320 240\n")
                .camera.fx,
            500.0);
  EXPECT_TRUE(findings_.empty()) << "equal";
  const LensCamera mean = Cameras(
      "1 SIMPLE_RADIAL 640 480 500 320 240 0.001\n2 SIMPLE_RADIAL 640 480 501 320 240 0.002\n");
  EXPECT_EQ(mean.camera, (Camera{640, 480, 500.5, 500.5, 319.5, 239.5}));
  EXPECT_NEAR(mean.distortion->k1, 0.0015, 1e-12);
  ASSERT_EQ(findings_.size(), 1u);
  EXPECT_NE(findings_[0].found.find("by 0.29 px"), std::string::npos) << findings_[0].found;
}

// Focal lengths 0.4 % apart are 0.5 px from their mean in images of 640 pixels, 3 px in those of
// 4000.
TEST_F(ColmapModelTest, TheSameAngleIsAllowedInImagesOfAnySize) {
  Cameras("1 SIMPLE_PINHOLE 640 480 500 320 240\n2 SIMPLE_PINHOLE 640 480 502 320 240\n");
  EXPECT_EQ(findings_.size(), 1u);
  Cameras("1 SIMPLE_PINHOLE 4000 3000 3000 2000 1500\n2 SIMPLE_PINHOLE 4000 3000 3012 2000 1500\n");
  EXPECT_EQ(findings_.size(), 1u);
  ExpectError<InputError>(
      [&] {
        Cameras(
            "1 SIMPLE_PINHOLE 4000 3000 3000 2000 1500\n"
            "2 SIMPLE_PINHOLE 4000 3000 3060 2000 1500\n");
      },
      {"another camera", "15.2 px", "to 6.2 px"});
}

TEST_F(ColmapModelTest, CamerasOfNoImageDoNotCount) {
  const std::string cameras =
      "1 PINHOLE 640 480 500 500 320 240\n2 PINHOLE 640 480 700 700 320 240\n"
      "3 PINHOLE 640 480 500 500 320 240\n";
  Write("images.txt", "1 1 0 0 0 0 0 0 1 a.jpg\n\n2 1 0 0 0 0 0 0 3 b.jpg\n\n");
  EXPECT_EQ(Cameras(cameras).camera.fx, 500.0);
  EXPECT_TRUE(findings_.empty());
  Write("images.txt", "1 1 0 0 0 0 0 0 1 a.jpg\n\n2 1 0 0 0 0 0 0 4 b.jpg\n\n");
  ExpectError<InputError>([&] { Cameras(cameras); }, {"images.txt:3", "camera 4", "one model"});
}

// An image without a line of image points is followed by the next one.
TEST_F(ColmapModelTest, MissingLinesOfImagePointsAreNamed) {
  const auto names = [&](const std::string& lines) {
    std::vector<std::string> images;
    for (const NamedPose& pose : ReadColmapPoses(Write("images.txt", lines))) {
      images.push_back(pose.image);
    }
    return images;
  };
  const std::vector<std::string> all = {"a.jpg", "b.jpg", "c.jpg"};
  const std::string a = "1 1 0 0 0 0 0 0 1 a.jpg\n", b = "2 1 0 0 0 0 0 0 1 b.jpg\n",
                    c = "3 1 0 0 0 0 0 0 1 c.jpg\n";
  const Printed printed = PrintedBy([&] { EXPECT_EQ(names(a + b + c), all); });
  EXPECT_NE(printed.output.find("3 of 3 images have no line"), std::string::npos);
  EXPECT_EQ(names(a + "1 2 3\n" + b + c), all);
  EXPECT_EQ(PrintedBy([&] { EXPECT_EQ(names(a + "\n" + b + "1 2 3\n" + c), all); }).output, "");
  ExpectError<InputError>([&] { names(a + "2 1 0 0 0 0 0 0 1 b c.jpg\n"); },
                          {"images.txt:2", "11 words", "an empty line"});
}

TEST_F(ColmapModelTest, BadPosesAreNamed) {
  ExpectBadTexts({{"1 0.5 0.5 0.5 0.5 3 -1 2 a.jpg\n", {":2", "9 words", "NAME"}},
                  {"1 0.5 0.5 0.5 0.6 3 -1 2 1 a.jpg\n", {":2", "norm"}},
                  {"1 0.5 x 0.5 0.5 3 -1 2 1 a.jpg\n", {":2", "QX is 'x'"}},
                  {"a 1 0 0 0 0 0 0 1 a.jpg\n", {"IMAGE_ID"}},
                  {"", {"no pose"}}},
                 "images.txt", [&](const std::string& lines) {
                   ReadColmapPoses(Write("images.txt", "# Image list\n" + lines));
                 });
}

// Bytes before numbers of the first camera and of the first point.
constexpr size_t kModelOfCamera = 12, kFocalLengthOfCamera = 32;
constexpr size_t kZOfPoint = 32, kImageOfPoint = 59;

// Two images and two points, in both formats; the second point comes first. The first image is that
// of a camera at (1, 2, 3) that looks along the world's x axis: its z is the world's x, its x the
// world's -y, its y the world's -z. camera_from_world is the quaternion of the inverse turn, and
// moves the camera's place to the origin.
class WholeModelTest : public FolderTest {
 protected:
  WholeModelTest() {
    Write("cameras.txt", "1 SIMPLE_RADIAL 640 480 500 320 240 0.1\n");
    WriteBytes(folder_ / "images.txt",
               "3 0.5 0.5 -0.5 0.5 2 3 -1 1 rgb/a b.jpg\n10.5 20.5 -1 1.5 2.5 7\n"
               "4 1 0 0 0 -4 0 0 1 rgb/c.jpg\n3 4 7\n");
    WriteBytes(folder_ / "points3D.txt",
               "9 4 5 6 255 0 0 -1 4 0 3 0\n7 1 2 3 0 0 0 0.25 3 1 4 0\n");
  }

  // A file of the binary model with the same content.
  static std::string InCorpus(const std::string& name) {
    return FileBytes(SOSLAM_SOURCE_DIR "/tests/fuzz/corpus/colmap/" + name);
  }
  // The file with other bytes at this place.
  template <typename Number>
  static std::string Patched(const std::string& name, size_t offset, Number number) {
    return InCorpus(name).replace(offset, sizeof number, reinterpret_cast<const char*>(&number),
                                  sizeof number);
  }
  void WriteBinary() {
    Write("cameras.bin", InCorpus("cameras_bin"));
    Write("images.bin", InCorpus("images_bin"));
    Write("points3D.bin", InCorpus("points_bin"));
  }
  void ExpectRefused(const std::vector<std::string>& words) {
    ExpectError<InputError>([&] { ReadColmapModel(folder_.path()); }, words);
  }
  void ExpectTheModel() {
    const ColmapModel model = ReadColmapModel(folder_.path());
    EXPECT_EQ(model.camera.camera, (Camera{640, 480, 500, 500, 319.5, 239.5}));
    EXPECT_EQ(model.camera.distortion, Distortion{0.1});
    ASSERT_EQ(model.images.size(), 2u);
    EXPECT_EQ(model.images[0].id, 3);
    EXPECT_EQ(model.images[0].pose.image, "rgb/a b.jpg");
    const Rigid3d& pose = model.images[0].pose.world_from_camera;
    EXPECT_TRUE(pose.translation.isApprox(Eigen::Vector3d(1, 2, 3)));
    EXPECT_TRUE((pose * Eigen::Vector3d(0, 0, 5)).isApprox(Eigen::Vector3d(6, 2, 3)));
    EXPECT_TRUE((pose * Eigen::Vector3d(5, 0, 0)).isApprox(Eigen::Vector3d(1, -3, 3)));
    EXPECT_EQ(model.images[1].pose.world_from_camera.translation.x(), 4.0);
    ASSERT_EQ(model.images[0].pixels.size(), 2u);
    EXPECT_EQ(model.images[0].pixels[1], Eigen::Vector2d(1, 2)) << "from the centre of a pixel";
    ASSERT_EQ(model.points.size(), 2u);
    EXPECT_EQ(model.points[0].id, 7u);
    EXPECT_EQ(model.points[0].position_in_world, Eigen::Vector3d(1, 2, 3));
    EXPECT_EQ(model.points[0].reprojection_error_px, 0.25);
    ASSERT_EQ(model.points[0].track.size(), 2u);
    EXPECT_EQ(model.points[0].track[0].image_id, 3);
    EXPECT_EQ(model.points[0].track[0].pixel_index, 1);
    EXPECT_EQ(model.points[1].reprojection_error_px, -1.0);
  }
};

TEST_F(WholeModelTest, TextAndBinaryAreTheSame) {
  EXPECT_TRUE(IsColmapModel(folder_.path()));
  EXPECT_FALSE(IsColmapModel(folder_ / "images.txt"));
  ExpectTheModel();
  Write("images.txt", "the text is not read where there is a binary model");
  WriteBinary();
  ExpectTheModel();
  EXPECT_EQ(ReadColmapPoses(folder_ / "images.bin")[1].image, "rgb/c.jpg");
  std::vector<Finding> findings;
  EXPECT_EQ(ReadCameraFile(folder_ / "cameras.bin", &findings).camera.camera.fx, 500);
}

TEST_F(WholeModelTest, BinaryFilesThatAreCutAreRefused) {
  for (const char* name : {"cameras.bin", "images.bin", "points3D.bin"}) {
    WriteBinary();
    const std::string whole = FileBytes(folder_ / name);
    for (size_t size = 0; size < whole.size(); size += 3) {
      Write(name, whole.substr(0, size));
      ExpectRefused({name, "expected"});
    }
    Write(name, whole + "x");
    ExpectRefused({name, "1 bytes after its last entry"});
  }
}

TEST_F(WholeModelTest, BinaryNumbersThatCannotBeAreRefused) {
  WriteBinary();
  Write("points3D.bin", Patched("points_bin", kZOfPoint, std::nan("")));
  ExpectRefused({"points3D.bin: point 1", "nan"});
  Write("points3D.bin", InCorpus("many_points_bin"));
  ExpectRefused({"points3D.bin", "1152921504606846976 points", "damaged"});
  Write("cameras.bin", Patched("cameras_bin", kModelOfCamera, std::int32_t{8}));
  ExpectRefused({"cameras.bin: camera 1", "'SIMPLE_RADIAL_FISHEYE'", "image_undistorter"});
  Write("cameras.bin", Patched("cameras_bin", kModelOfCamera, std::int32_t{77}));
  ExpectRefused({"cameras.bin: camera 1", "model 77"});
  Write("cameras.bin", Patched("cameras_bin", kFocalLengthOfCamera, -500.0));
  ExpectRefused({"cameras.bin: camera 1", "focal length above 0"});
}

// Observations in images that were taken out of the model, or whose image points were.
TEST_F(WholeModelTest, ObservationsThatNoImageHasAreLeftOut) {
  WriteBinary();
  Write("points3D.bin", Patched("points_bin", kImageOfPoint, std::uint32_t{5}));
  const ColmapModel without_image = ReadColmapModel(folder_.path());
  EXPECT_EQ(without_image.points[0].track.size(), 2u);
  EXPECT_EQ(without_image.points[1].track.size(), 1u) << "that of point 9";
  ASSERT_EQ(without_image.findings.size(), 1u);
  EXPECT_NE(without_image.findings[0].found.find("1 of 4 observations"), std::string::npos);
  std::filesystem::remove(folder_ / "cameras.bin");
  WriteBytes(folder_ / "images.txt",
             "3 1 0 0 0 0 0 0 1 rgb/a.jpg\n10.5 20.5 -1 1.5 2.5 7\n4 1 0 0 0 0 0 0 1 b.jpg\n\n");
  const ColmapModel without_pixels = ReadColmapModel(folder_.path());
  EXPECT_EQ(without_pixels.points[0].track.size(), 1u) << "that of image 4";
  std::filesystem::remove(folder_ / "points3D.txt");
  EXPECT_TRUE(ReadColmapModel(folder_.path()).points.empty());
}

TEST_F(WholeModelTest, TracksOfOtherModelsAreRefused) {
  std::filesystem::remove(folder_ / "cameras.bin");
  Write("points3D.txt", "7 1 2 3 0 0 0 0.25 3 2\n");
  ExpectRefused({"points3D.txt: point 7", "image point 2 of image 3"});
  Write("points3D.txt", "7 1 2 3 0 0 0 0.25\n7 1 2 3 0 0 0 0.25\n");
  ExpectRefused({"points3D.txt", "two points with id 7"});
  Write("points3D.txt", "7 1 2 3 0 0 0 0.25 3\n");
  ExpectRefused({"points3D.txt:1", "9 words", "POINT2D_IDX"});
  Write("images.txt", "3 1 0 0 0 -4 0 0 1 c.jpg\n3 4\n");
  ExpectRefused({"images.txt:2", "2 words", "POINT3D_ID"});
  Write("points3D.txt", "");
  Write("images.txt", "3 1 0 0 0 0 0 0 1 c.jpg\n\n3 1 0 0 0 0 0 0 1 d.jpg\n\n");
  ExpectRefused({"images.txt:3", "second image with id 3"});
}

}  // namespace
}  // namespace soslam

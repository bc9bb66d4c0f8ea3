// SPDX-License-Identifier: BSD-3-Clause
// The usual mistakes in cameras, planes and clocks, each in a dataset that is right but for it.
#include "soslam/dataset/dataset_checks.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/dataset_checks_fixture.h"

namespace soslam {
namespace {

using testing::IsEmpty;

TEST_F(DatasetChecksTest, NothingIsFoundWhereNothingIsWrong) {
  dataset.has_truth = true;
  WriteImages(640, 480);
  EXPECT_THAT(Warnings(), IsEmpty());
}

TEST_F(DatasetChecksTest, NothingIsFoundWithoutObjectIds) {
  dataset.has_object_ids = false;
  EXPECT_THAT(Warnings(), IsEmpty());
}

// Cameras.

TEST_F(DatasetChecksTest, ImagesOfAnotherSize) {
  WriteImages(320, 240);
  ExpectRefused(
      {"24 of 24 images are of 320 x 240", "640 x 480", "smaller or larger", "times 0.5"});
}

TEST_F(DatasetChecksTest, ImagesOfSwappedSides) {
  WriteImages(480, 640);
  ExpectRefused({"width and height swapped"});
}

TEST_F(DatasetChecksTest, ImagesThatAreTurnedByAQuarterAreOfTheSizeThatIsShown) {
  WriteImages(480, 640, /*exif_orientation=*/6);
  EXPECT_THAT(Warnings(), IsEmpty());
  options_.image_orientation = ImageOrientation::kStored;
  ExpectRefused({"480 x 640"});
}

TEST_F(DatasetChecksTest, ImagesThatAreTurnedUpsideDown) {
  WriteImages(640, 480, /*exif_orientation=*/3);
  ExpectWarning({"24 of 24 images", "image_orientation stored"});
  options_.image_orientation = ImageOrientation::kStored;
  EXPECT_THAT(Warnings(), IsEmpty());
}

TEST_F(DatasetChecksTest, BoxesAndACameraThatSoslamMadeAreUpright) {
  WriteImages(640, 480, /*exif_orientation=*/3);
  const auto import_with = [&](const std::string& source, const std::string& first_line) {
    dataset.camera_source = source;
    dataset.first_line_of_boxes = first_line;
    return Warnings();
  };
  const std::string upright = "# Written by soslam-frames from boxes.csv\n";
  EXPECT_THAT(import_with("soslam-reconstruct", upright), IsEmpty());
  for (const auto& [orientation, findings] : {std::pair("upright", 0u), std::pair("stored", 1u)}) {
    const nlohmann::json header = {{"settings", {{"image_orientation", orientation}}}};
    EXPECT_THAT(import_with("soslam-reconstruct", "# " + header.dump() + "\n"),
                testing::SizeIs(findings));
  }
  EXPECT_THAT(import_with("soslam-reconstruct", ""), testing::SizeIs(1));
  EXPECT_THAT(import_with("calibration", upright), testing::SizeIs(1));
}

// A camera of the stored images.
TEST_F(DatasetChecksTest, ImagesThatAreShownWithSwappedSides) {
  WriteImages(640, 480, /*exif_orientation=*/6);
  ExpectRefused({"480 x 640", "as they are stored", "image_orientation stored"});
  options_.image_orientation = ImageOrientation::kStored;
  EXPECT_THAT(Warnings(), IsEmpty());
}

// COLMAP does not turn them, whatever size the camera has.
TEST_F(DatasetChecksTest, TurnedImagesWithPosesOfColmap) {
  WriteColmap();
  WriteImages(640, 480);
  EXPECT_THAT(Warnings(), IsEmpty());
  WriteImages(480, 640, /*exif_orientation=*/6);
  ExpectWarning({"image_orientation: 24 of 24 images", "COLMAP's poses and camera",
                 "image_orientation stored"});
}

TEST_F(DatasetChecksTest, CamerasThatCannotBe) {
  for (const auto& [camera, words] : std::vector<std::pair<Camera, std::vector<std::string>>>{
           {{480, 640, 500, 500, 319.5, 239.5}, {"swapped", "width 640, height 480"}},
           {{640, 480, 1000, 1000, 639.5, 479.5}, {"2 times as large", "fx, fy, cx, cy by 1.99"}},
           {{640, 480, 0.78, 1.04, 0.5, 0.5}, {"fractions of the image"}},
           {{640, 480, 4.2, 4.2, 319.5, 239.5}, {"millimetres"}},
           {{640, 480, 500, 500, 319.5, 700}, {"another camera"}}}) {
    dataset.written_camera = camera;
    ExpectRefused(words);
  }
}

TEST_F(DatasetChecksTest, AFocalLengthOfAnotherImage) {
  dataset.written_camera.fy = 1500.0;
  ExpectAmongWarnings({"camera_intrinsics: ", "fx 500, fy 1500", "pixels are square"});
  dataset.written_camera.fy = 260.0;  // an anamorphic lens
  EXPECT_THAT(Warnings(), testing::Not(testing::Contains(HasSubstr("camera_intrinsics"))));
}

// A lens whose model ends at a radius of 0.26 within the image, and one that is no lens.
TEST_F(DatasetChecksTest, LensModelsThatEndWithinTheImage) {
  options_.folder.distortion = "-5 0 0 0";
  ExpectAmongWarnings({"camera_lens: ", "-5 0 0 0 0", "the pixel (64, 240) has no undistorted"});
  options_.folder.distortion = "5 0 0 0";
  ExpectAmongWarnings({"camera_lens: ", "(64, 240) is (154, 240)"});
  for (const char* real :
       {"-0.25761402 0.0877087 -0.00025697 -0.00059339 -0.01521941", "-0.4 0.2 0.001 -0.001",
        "0.2624 -0.9531 -0.0054 0.0026 1.1633", "0.2 0 0 0", "5.2 1.1 0 0 0.02 5.5 2.9 0.25"}) {
    options_.folder.distortion = real;
    EXPECT_THAT(Warnings(), testing::Not(testing::Contains(HasSubstr("camera_lens")))) << real;
  }
}

TEST_F(DatasetChecksTest, ANearlySquareCameraHasNoSwappedSides) {
  dataset.camera = dataset.written_camera = {660, 620, 500.0, 500.0, 325.0, 314.0};
  EXPECT_THAT(Warnings(), IsEmpty());
}

// Without images only the boxes tell.
TEST_F(DatasetChecksTest, CameraOfLargerImagesThanTheBoxes) {
  dataset.box = [](const Box& b) {  // all over the image, and cut by it
    const auto cut = [](double x, double size) {
      return std::clamp(0.5 * size + 3.0 * (x - 0.5 * size), -0.5, size - 0.5);
    };
    return std::array{cut(b.x_min, 640), cut(b.y_min, 480), cut(b.x_max, 640), cut(b.y_max, 480)};
  };
  dataset.written_camera = {1280, 960, 1000.0, 1000.0, 639.5, 479.5};
  ExpectAmongWarnings({"box_extent", "1280 x 960", "made smaller"});
}

// Planes.

// Boxes of one label and without ids do not tell where the balls are.
TEST_F(DatasetChecksTest, NormalThatPointsDown) {
  dataset.plane = R"([{"id": 0, "normal": [0, 0, -1], "d": 0}])";
  ExpectRefused({"from below", "sign of the normal"});
  dataset.has_object_ids = false;
  dataset.label = [](size_t) { return "ball"; };
  ExpectWarning({"plane_side", "may be the objects"});
}

TEST_F(DatasetChecksTest, OffsetOfTheOtherSign) {
  dataset.height_of_floor = -2.0;
  dataset.plane = R"([{"id": 0, "normal": [0, 0, 1], "d": -2}])";
  ExpectRefused({"d of the other sign"});
}

// A table that a low camera looks up to.
TEST_F(DatasetChecksTest, CamerasBelowATable) {
  dataset.camera_height = -0.5;
  EXPECT_THAT(Warnings(), IsEmpty());
}

TEST_F(DatasetChecksTest, WallForFloor) {
  dataset.plane = R"([{"id": 0, "normal": [1, 0, 0], "d": 5}])";
  ExpectWarning({"plane_attitude", "a wall"});
}

TEST_F(DatasetChecksTest, AFloorSeenByARolledCameraIsNoWall) {
  dataset.roll_rad = 0.5 * std::numbers::pi;
  EXPECT_THAT(Warnings(), IsEmpty());
}

// Clocks.

TEST_F(DatasetChecksTest, PosesInNanoseconds) {
  dataset.pose_time = [](double t) { return fmt::format("{:.0f}", 1e9 * t); };
  ExpectRefused({"0 of 24 images", "poses in nanoseconds", "ratio 1e+09", "divide"});
}

TEST_F(DatasetChecksTest, ImagesInMilliseconds) {
  dataset.image_time = [](double t) { return fmt::format("{:.0f}", 1e3 * t); };
  ExpectRefused({"images in milliseconds"});
}

TEST_F(DatasetChecksTest, AnotherClock) {
  dataset.pose_time = [](double t) { return fmt::format("{:.6f}", t + 5000.0); };
  ExpectRefused({"other clocks", "5000.000 apart"});
}

// The first pose has the time of the first image.
TEST_F(DatasetChecksTest, AClockThatRunsFasterOrSlower) {
  for (const double rate : {0.001, 0.125, 8.0, 1000.0}) {
    dataset.pose_time = [=](double t) { return fmt::format("{:.6f}", 100.0 + rate * (t - 100.0)); };
    ExpectRefused({fmt::format("runs {:g} times as fast", rate),
                   fmt::format("as 100.000 + (t - 100.000) / {:g}", rate)});
    EXPECT_THAT(Refusal(), testing::Not(HasSubstr("about their z axis")));
  }
}

TEST_F(DatasetChecksTest, AClockThatJumps) {
  dataset.pose_time = [](double t) { return fmt::format("{:.6f}", t < 104.0 ? t : t + 5000.0); };
  ExpectAmongWarnings({"timestamps: 8 of 24 images", "max_time_difference_s"});
}

TEST(CheckTimestampsTest, PosesOfAPartOfTheImages) {
  std::vector<ListedImage> images;
  for (int i = 0; i < 10; ++i) images.push_back({1.0 * i, "a.png"});
  std::vector<TimedPose> poses = {{3.0, {}}, {4.0, {}}, {5.0, {}}};
  const Finding of_part = Only(CheckTimestamps(images, poses, "odometry.txt", 0.02));
  EXPECT_THAT(of_part.found, testing::HasSubstr("3 of 10 images have a pose"));
  EXPECT_THAT(of_part.cause, testing::HasSubstr("a part of the images"));
  EXPECT_THAT(of_part.remedy, testing::HasSubstr("poses of all images"));
  poses.push_back({5.5, {}});
  const Finding of_others = Only(CheckTimestamps(images, poses, "odometry.txt", 0.02));
  EXPECT_THAT(of_others.cause, testing::HasSubstr("poses of other images"));
}

TEST_F(DatasetChecksTest, EqualTimestamps) {
  dataset.image_time = [](double t) { return fmt::format("{:.0f}", std::floor(t)); };
  options_.max_time_difference_s = 0.6;
  ExpectAmongWarnings({"equal_timestamps", "12 of 24 images"});
}

}  // namespace
}  // namespace soslam

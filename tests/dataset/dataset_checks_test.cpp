// SPDX-License-Identifier: BSD-3-Clause
// The usual mistakes in cameras, planes and clocks, each in a dataset that is right but for it.
#include "dataset/dataset_checks.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/dataset_checks_fixture.h"

namespace soslam {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
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
  EXPECT_THAT(Refusal(),
              AllOf(HasSubstr("24 of 24 images are of 320 x 240"), HasSubstr("640 x 480"),
                    HasSubstr("smaller or larger"), HasSubstr("times 0.5")));
}

TEST_F(DatasetChecksTest, ImagesOfSwappedSides) {
  WriteImages(480, 640);
  EXPECT_THAT(Refusal(), HasSubstr("width and height swapped"));
}

TEST_F(DatasetChecksTest, ImagesThatAreTurnedByAQuarterAreOfTheSizeThatIsShown) {
  WriteImages(480, 640, /*exif_orientation=*/6);
  EXPECT_THAT(Warnings(), IsEmpty());
  options.image_orientation = ImageOrientation::kStored;
  EXPECT_THAT(Refusal(), HasSubstr("480 x 640"));
}

TEST_F(DatasetChecksTest, ImagesThatAreTurnedUpsideDown) {
  WriteImages(640, 480, /*exif_orientation=*/3);
  EXPECT_THAT(Warnings(), ElementsAre(AllOf(HasSubstr("24 of 24 images"),
                                            HasSubstr("image_orientation stored"))));
  options.image_orientation = ImageOrientation::kStored;
  EXPECT_THAT(Warnings(), IsEmpty());
}

// A camera of the stored images.
TEST_F(DatasetChecksTest, ImagesThatAreShownWithSwappedSides) {
  WriteImages(640, 480, /*exif_orientation=*/6);
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("480 x 640"), HasSubstr("as they are stored"),
                               HasSubstr("image_orientation stored")));
  options.image_orientation = ImageOrientation::kStored;
  EXPECT_THAT(Warnings(), IsEmpty());
}

// COLMAP does not turn them, whatever size the camera has.
TEST_F(DatasetChecksTest, TurnedImagesWithPosesOfColmap) {
  WriteColmap();
  WriteImages(640, 480);
  EXPECT_THAT(Warnings(), IsEmpty());
  WriteImages(480, 640, /*exif_orientation=*/6);
  EXPECT_THAT(Warnings(), ElementsAre(AllOf(HasSubstr("image_orientation: 24 of 24 images"),
                                            HasSubstr("COLMAP's poses and camera"),
                                            HasSubstr("image_orientation stored"))));
}

TEST_F(DatasetChecksTest, CameraOfSwappedSides) {
  dataset.written_camera = {480, 640, 500.0, 500.0, 319.5, 239.5};
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("swapped"), HasSubstr("width 640, height 480")));
}

TEST_F(DatasetChecksTest, IntrinsicsOfLargerImages) {
  dataset.written_camera = {640, 480, 1000.0, 1000.0, 639.5, 479.5};
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("images 2 times as large"),
                               HasSubstr("divide fx, fy, cx, cy by 1.99")));
}

TEST_F(DatasetChecksTest, IntrinsicsAsFractions) {
  dataset.written_camera = {640, 480, 0.78, 1.04, 0.5, 0.5};
  EXPECT_THAT(Refusal(), HasSubstr("fractions of the image"));
}

TEST_F(DatasetChecksTest, FocalLengthInMillimetres) {
  dataset.written_camera = {640, 480, 4.2, 4.2, 319.5, 239.5};
  EXPECT_THAT(Refusal(), HasSubstr("millimetres"));
}

TEST_F(DatasetChecksTest, ANearlySquareCameraHasNoSwappedSides) {
  dataset.camera = dataset.written_camera = {660, 620, 500.0, 500.0, 325.0, 314.0};
  EXPECT_THAT(Warnings(), IsEmpty());
}

TEST_F(DatasetChecksTest, PrincipalPointOutsideOfTheImage) {
  dataset.written_camera = {640, 480, 500, 500, 319.5, 700.0};
  EXPECT_THAT(Refusal(), HasSubstr("another camera"));
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
  EXPECT_THAT(Warnings(), testing::Contains(AllOf(HasSubstr("box_extent"), HasSubstr("1280 x 960"),
                                                  HasSubstr("made smaller"))));
}

// Planes.

TEST_F(DatasetChecksTest, NormalThatPointsDown) {
  dataset.plane = R"([{"id": 0, "normal": [0, 0, -1], "d": 0}])";
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("from below"), HasSubstr("sign of the normal")));
}

// Boxes of one label and without ids do not tell where the balls are.
TEST_F(DatasetChecksTest, NormalThatPointsDownWhereBoxesDoNotTell) {
  dataset.has_object_ids = false;
  dataset.label = [](size_t) { return "ball"; };
  dataset.plane = R"([{"id": 0, "normal": [0, 0, -1], "d": 0}])";
  EXPECT_THAT(Warnings(),
              ElementsAre(AllOf(HasSubstr("plane_side"), HasSubstr("may be the objects"))));
}

TEST_F(DatasetChecksTest, OffsetOfTheOtherSign) {
  dataset.height_of_floor = -2.0;
  dataset.plane = R"([{"id": 0, "normal": [0, 0, 1], "d": -2}])";
  EXPECT_THAT(Refusal(), HasSubstr("d of the other sign"));
}

// A table that a low camera looks up to.
TEST_F(DatasetChecksTest, CamerasBelowATable) {
  dataset.camera_height = -0.5;
  EXPECT_THAT(Warnings(), IsEmpty());
}

TEST_F(DatasetChecksTest, WallForFloor) {
  dataset.plane = R"([{"id": 0, "normal": [1, 0, 0], "d": 5}])";
  EXPECT_THAT(Warnings(), ElementsAre(AllOf(HasSubstr("plane_attitude"), HasSubstr("a wall"))));
}

TEST_F(DatasetChecksTest, AFloorSeenByARolledCameraIsNoWall) {
  dataset.roll_rad = 0.5 * std::numbers::pi;
  EXPECT_THAT(Warnings(), IsEmpty());
}

// Clocks.

TEST_F(DatasetChecksTest, PosesInNanoseconds) {
  dataset.pose_time = [](double t) { return fmt::format("{:.0f}", 1e9 * t); };
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("0 of 24 images"), HasSubstr("poses in nanoseconds"),
                               HasSubstr("ratio 1e+09"), HasSubstr("divide")));
}

TEST_F(DatasetChecksTest, ImagesInMilliseconds) {
  dataset.image_time = [](double t) { return fmt::format("{:.0f}", 1e3 * t); };
  EXPECT_THAT(Refusal(), HasSubstr("images in milliseconds"));
}

TEST_F(DatasetChecksTest, BothInNanoseconds) {
  dataset.image_time = [](double t) { return fmt::format("{:.0f}", 1e9 * (t + 1.7e9)); };
  dataset.pose_time = [](double t) { return fmt::format("{:.0f}", 1e9 * (t + 1.7e9) + 3e6); };
  EXPECT_THAT(Refusal(), HasSubstr("images and poses in nanoseconds"));
}

TEST_F(DatasetChecksTest, AnotherClock) {
  dataset.pose_time = [](double t) { return fmt::format("{:.6f}", t + 5000.0); };
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("other clocks"), HasSubstr("5000.000 apart")));
}

TEST_F(DatasetChecksTest, AClockThatJumps) {
  dataset.pose_time = [](double t) { return fmt::format("{:.6f}", t < 104.0 ? t : t + 5000.0); };
  EXPECT_THAT(Warnings(), testing::Contains(AllOf(HasSubstr("timestamps: 8 of 24 images"),
                                                  HasSubstr("max_time_difference_s"))));
}

TEST_F(DatasetChecksTest, EqualTimestamps) {
  dataset.image_time = [](double t) { return fmt::format("{:.0f}", std::floor(t)); };
  options.max_time_difference_s = 0.6;
  EXPECT_THAT(Warnings(), testing::Contains(
                              AllOf(HasSubstr("equal_timestamps"), HasSubstr("12 of 24 images"))));
}

}  // namespace
}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "soslam/base/error.h"
#include "soslam/dataset/colmap_model.h"
#include "soslam/exchange/exports.h"
#include "support/expect_error.h"
#include "support/exported_world.h"
#include "support/folder_test.h"
#include "support/run_command.h"

namespace soslam {
namespace {

using testing::HasSubstr;

// A world whose first two frames see two points, and the third, which has no image, the first.
class ColmapTextsTest : public FolderTest {
 protected:
  ColmapTextsTest() {
    for (WorldFrame& frame : world_.frames) frame.world_from_camera.rotation = RandomRotation();
    world_.points = {
        {{1.0, 2.0, 3.0}, 0.25, {{10, {4.0, 5.5}}, {15, {6.0, 7.0}}, {20, {1, 1}}}, {1, 20, 255}},
        {{-1.0, 0.0, 1.0 / 3.0}, 0.5, {{15, {8.0, 9.0}}}}};
  }

  ColmapModel ReadBack() const {
    WriteModel();
    return ReadColmapModel(folder_.path());
  }
  void WriteModel() const {
    const ColmapTexts texts = ColmapModelTexts(world_, FolderOfImages({world_}));
    Write("cameras.txt", texts.cameras);
    Write("images.txt", texts.images);
    Write("points3D.txt", texts.points3D);
  }
  void ExpectIsWorld(const ColmapModel& model) const {
    EXPECT_EQ(model.camera, (LensCamera{TestCamera(), world_.image_distortion}));
    EXPECT_TRUE(model.findings.empty());
    ASSERT_EQ(model.images.size(), 2u);
    for (size_t i = 0; i < 2; ++i) {
      const WorldFrame& frame = world_.frames[i];
      const Rigid3d& read = model.images[i].pose.world_from_camera;
      EXPECT_EQ(model.images[i].id, frame.id + 1);
      EXPECT_EQ("rgb/" + model.images[i].pose.image, frame.image);
      EXPECT_LT((read.translation - frame.world_from_camera.translation).norm(), 1e-12);
      EXPECT_LT(read.rotation.angularDistance(frame.world_from_camera.rotation), 1e-7);
    }
    ASSERT_EQ(model.points.size(), 2u);
    EXPECT_EQ(model.points[0].position_in_world, world_.points[0].position_in_world);
    EXPECT_EQ(model.points[1].reprojection_error_px, 0.5);
    EXPECT_NEAR(model.points[0].grey, 0.299 + 0.587 * 20 + 0.114 * 255, 1e-9);
    const auto pixels = [&](size_t point) {
      std::vector<Eigen::Vector2d> seen;
      for (const auto& [image_id, index] : model.points[point].track) {
        seen.push_back(model.images[image_id == 11 ? 0 : 1].pixels.at(index));
      }
      return seen;
    };
    EXPECT_EQ(pixels(0), (std::vector<Eigen::Vector2d>{{4.0, 5.5}, {6.0, 7.0}}));
    EXPECT_EQ(pixels(1), (std::vector<Eigen::Vector2d>{{8.0, 9.0}}));
  }

  World world_ = ExportedWorld();
};

TEST_F(ColmapTextsTest, ModelReaderReadsThemBack) {
  ExpectIsWorld(ReadBack());
  world_.image_distortion = Distortion{.k1 = 0.1, .p2 = -0.01};
  ExpectIsWorld(ReadBack());
}

// The middle of the image, 640 x 480 pixels, is at 320, 240 from its corner.
TEST_F(ColmapTextsTest, PixelsCountFromTheCorner) {
  for (WorldFrame& frame : world_.frames) frame.camera = {640, 480, 500, 500, 319.5, 239.5};
  world_.points[1].observations[0].pixel = {319.5, 239.5};
  const ColmapTexts texts = ColmapModelTexts(world_, "rgb");
  EXPECT_THAT(texts.cameras, HasSubstr("\n1 PINHOLE 640 480 500 500 320 240\n"));
  EXPECT_THAT(texts.images, HasSubstr(" 320 240 2\n"));
}

TEST_F(ColmapTextsTest, CamerasOfFramesAreListedOnce) {
  world_.frames[2].image = "rgb/c.png";
  world_.frames[1].camera.fx = 600.0;
  const ColmapTexts texts = ColmapModelTexts(world_, "rgb");
  EXPECT_THAT(texts.cameras, HasSubstr("\n2 PINHOLE 640 480 600 "));
  EXPECT_THAT(texts.cameras, testing::Not(HasSubstr("\n3 ")));
  EXPECT_THAT(texts.images, HasSubstr(" 1 a.png\n"));
  EXPECT_THAT(texts.images, HasSubstr(" 2 b.png\n"));
  EXPECT_THAT(texts.images, HasSubstr(" 1 c.png\n"));
}

TEST_F(ColmapTextsTest, NamesAreThoseInTheFolderOfAllImages) {
  EXPECT_EQ(FolderOfImages({world_}), "rgb");
  world_.frames[1].image = "rgb/left/b.png";
  EXPECT_EQ(FolderOfImages({world_}), "rgb");
  World other = world_;
  other.frames[0].image = "c.png";
  EXPECT_EQ(FolderOfImages({world_, other}), "");
  EXPECT_THAT(ColmapModelTexts(other, "").images, HasSubstr(" 1 c.png\n"));
  EXPECT_THAT(ColmapModelTexts(world_, "rgb").images, HasSubstr(" 1 left/b.png\n"));
}

TEST_F(ColmapTextsTest, NamesThatColmapWouldCutOffAreRefused) {
  world_.frames[1].image = "rgb/IMG 1.png";
  ExpectError<InputError>([&] { ColmapModelTexts(world_, "rgb"); },
                          {"frame 15", "'rgb/IMG 1.png'", "blank"});
}

// COLMAP itself reads the model, and what it writes of it is the same.
TEST_F(ColmapTextsTest, ColmapReadsThem) {
  if (RunCommand({"which", "colmap"}).exit_code != 0) GTEST_SKIP() << "there is no COLMAP";
  world_.image_distortion = Distortion{.k1 = 0.1, .p2 = -0.01};
  WriteModel();
  const CommandResult analysed =
      ExpectExit(0, RunCommand({"colmap", "model_analyzer", "--path", folder_.path()}));
  for (const char* words : {"Registered images: 2\n", "Points: 2\n", "Observations: 3\n"}) {
    EXPECT_THAT(analysed.output + analysed.errors, HasSubstr(words));
  }
  std::filesystem::create_directory(folder_ / "binary");
  ExpectSuccess(RunCommand({"colmap", "model_converter", "--input_path", folder_.path(),
                            "--output_path", folder_ / "binary", "--output_type", "BIN"}));
  ColmapModel model = ReadColmapModel(folder_ / "binary");
  std::ranges::sort(model.images, {}, &ColmapImage::id);
  ExpectIsWorld(model);
}

}  // namespace
}  // namespace soslam

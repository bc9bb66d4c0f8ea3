// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "soslam/artefact/files.h"
#include "soslam/base/error.h"
#include "soslam/dataset/colmap_model.h"
#include "soslam/dataset/nerfstudio.h"
#include "soslam/inspection/canvas.h"
#include "soslam/stage/stages.h"
#include "support/expect_error.h"
#include "support/image_files.h"
#include "support/printed.h"
#include "support/true_map.h"
#include "support/wall_sequence.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// What soslam-export makes of images: those of a wall, with a map of a cuboid before it.
class ExportImagesTest : public WallSequenceTest {
 protected:
  ExportImagesTest() {
    sequence_.planes = {{0, {-Eigen::Vector3d::UnitY(), 1.0}}};
    sequence_.objects = {{4, "cup", 0, {}}};
    map_ = EmptyMap(sequence_);
    const Landmark cube{
        {Eigen::Quaterniond::Identity(), {0.2, 0.0, 2.0}}, {0.2, 0.2, 0.2}, kCuboidExponent};
    map_.objects = {{0, 3, cube, {}, ""}};
    for (const char* output : {"colmap", "overlays"}) outputs_[output] = folder_ / "out" / output;
    outputs_["transforms"] = folder_ / "out/transforms.json";
  }

  // The printed text.
  Printed Run(const std::vector<std::string>& outputs, int threads = 2) {
    WriteSequence(folder_ / "sequence.json", sequence_, {});
    WriteMap(folder_ / "map.json", map_, sequence_, {{}, {folder_ / "sequence.json"}});
    StageFiles files = files_;
    files["map"] = folder_ / "map.json";
    if (fs::exists(folder_ / "points.h5")) files["points"] = folder_ / "points.h5";
    for (const std::string& output : outputs) files[output] = outputs_.at(output);
    return PrintedBy([&] { RunExport({}, files, threads); });
  }

  MapEstimate map_;
  StageFiles outputs_;
};

TEST_F(ExportImagesTest, OverlaysHaveTheNamesAndSizeOfImages) {
  EXPECT_THAT(Run({"overlays"}).output, HasSubstr("overlays: 9 images"));
  for (int i = 0; i < kImages; ++i) {
    const cv::Mat drawn =
        cv::imread((folder_ / "out/overlays" / (std::to_string(i) + ".jpg")).string());
    const cv::Mat image = cv::imread((folder_ / sequence_.frames[i].image).string());
    ASSERT_FALSE(drawn.empty());
    ASSERT_EQ(drawn.cols, DrawingGround(image).cols);
    // The left edge of the nearer face, at 1.8 m, in sky blue, which JPEG blurs; the rest is grey.
    const auto centre = sequence_.camera.Project({0.2 - 0.06 * i, 0.0, 1.8});
    ASSERT_TRUE(centre);
    const double scale = static_cast<double>(drawn.cols) / image.cols;
    const auto left = static_cast<int>(scale * (centre->x() - kFocalPx * 0.2 / 1.8));
    const auto row = static_cast<int>(scale * 119.5);
    int bluest = 0;
    for (int x = left - 8; x <= left + 8; ++x) {
      const auto& pixel = drawn.at<cv::Vec3b>(row, x);
      bluest = std::max(bluest, pixel[0] - pixel[2]);
    }
    EXPECT_GT(bluest, 40) << i;
  }
}

TEST_F(ExportImagesTest, ImagesOfOneNameButForTheExtensionKeepIt) {
  Write("rgb/1.jpg", EncodedImage(".jpg", cv::imread((folder_ / "rgb/0.png").string())));
  sequence_.frames[0].image = "rgb/1.jpg";
  Run({"overlays"});
  for (const char* name : {"1.jpg.jpg", "1.png.jpg", "2.png.jpg"}) {
    EXPECT_TRUE(fs::exists(folder_ / "out/overlays" / name)) << name;
  }
}

TEST_F(ExportImagesTest, SameBytesForAnyNumberOfThreads) {
  std::vector<fs::path> files;
  for (int i = 0; i < kImages; ++i) {
    files.push_back(folder_ / "out/overlays" / (std::to_string(i) + ".jpg"));
  }
  ExpectSameBytesForThreads([&](int threads) { Run({"overlays"}, threads); }, files);
}

TEST_F(ExportImagesTest, MissingImagesAreNamed) {
  fs::remove(folder_ / "rgb/3.png");
  ExpectError<InputError>([&] { Run({"overlays"}); }, {"3.png"});
}

// Cameras move along x; a point on the wall is seen at x - 6 px per image, on a red patch.
TEST_F(ExportImagesTest, ModelHasPointsInTheirColours) {
  MapPoint point;
  point.position_in_world = {100.0, 100.0, 100.0};  // of another world
  for (int i = 0; i < kImages; ++i) {
    const cv::Point place(200 - i * kShiftPx, 100);
    const fs::path path = folder_ / sequence_.frames[i].image;
    cv::Mat image = cv::imread(path.string());
    cv::circle(image, place, 2, {10, 20, 250}, cv::FILLED);
    WriteBytes(path, EncodedImage(".png", image));
    point.observations.push_back({5 * i, {place.x, place.y}});
  }
  WritePoints(folder_ / "points.h5", {point}, {});
  const Printed printed = Run({"colmap", "transforms"});
  EXPECT_EQ(printed.errors, "");
  const ColmapModel model = ReadColmapModel(folder_ / "out/colmap");
  ASSERT_EQ(model.points.size(), 1u);
  const Eigen::Vector3d expected((200 - 159.5) / kFocalPx * kDepthM,
                                 (100 - 119.5) / kFocalPx * kDepthM, kDepthM);
  EXPECT_LT((model.points[0].position_in_world - expected).norm(), 1e-6);
  EXPECT_NEAR(model.points[0].grey, 0.299 * 250 + 0.587 * 20 + 0.114 * 10, 1e-6);
  EXPECT_EQ(model.points[0].track.size(), static_cast<size_t>(kImages));
  EXPECT_EQ(model.images[1].pose.image, "1.png");

  std::vector<Finding> findings;
  const auto poses = ReadNerfstudioPoses(folder_ / "out/transforms.json", &findings);
  EXPECT_EQ(poses.at(1).image, "../rgb/1.png");
  EXPECT_TRUE(fs::equivalent(folder_ / "out" / poses[1].image, folder_ / "rgb/1.png"));
}

TEST_F(ExportImagesTest, PointsThatPosesDoNotExplainAreSaid) {
  MapPoint point;
  for (int i = 0; i < kImages; ++i) {
    point.observations.push_back({5 * i, {200.0 - i * kShiftPx, i % 2 == 0 ? 60.0 : 140.0}});
  }
  WritePoints(folder_ / "points.h5", {point}, {});
  EXPECT_THAT(Run({"colmap"}).errors, HasSubstr("reprojection error"));
}

TEST_F(ExportImagesTest, ImagesThatExifTurnsAreSaid) {
  sequence_.frames.resize(1);
  map_.world_from_camera.resize(1);
  const cv::Mat image = cv::imread((folder_ / "rgb/0.png").string());
  Write("rgb/0.jpg", JpegWithExif(EncodedImage(".jpg", image), ExifOf(3)));
  sequence_.frames[0].image = "rgb/0.jpg";
  EXPECT_THAT(Run({"colmap"}).errors, HasSubstr("1 of 1 images are turned by EXIF"));
  sequence_.image_orientation = ImageOrientation::kStored;
  EXPECT_EQ(Run({"colmap"}).errors, "");
}

}  // namespace
}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "soslam/base/error.h"
#include "soslam/dataset/colmap_model.h"
#include "soslam/image/distort_pixels.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/image_files.h"
#include "support/lists.h"

namespace soslam {
namespace {

constexpr int kWidth = 64, kHeight = 48;  // of the stored images

// The position in the stored image of a pixel that viewers show, as EXIF 2.32 defines orientations.
Eigen::Vector2d StoredPosition(int orientation, const Eigen::Vector2d& shown) {
  constexpr double kRight = kWidth - 1, kBottom = kHeight - 1;
  const double x = shown.x(), y = shown.y();
  const Eigen::Vector2d positions[] = {
      {x, y}, {kRight - x, y},  {kRight - x, kBottom - y}, {x, kBottom - y},
      {y, x}, {y, kBottom - x}, {kRight - y, kBottom - x}, {kRight - y, x}};
  return positions[orientation - 1];
}

// Two images of a lens, and points whose colours are those of their image points.
class TurnModelTest : public FolderTest {
 protected:
  TurnModelTest() {
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) stored_.at<uchar>(y, x) = static_cast<uchar>(2 * x + 2 * y);
    }
    WithLens({});
    for (int i = 0; i < 30; ++i) {
      points_.emplace_back(0.2 * (i % 6 - 2), 0.15 * (i / 6 - 2), 2.0 + 0.1 * (i % 4));
    }
  }

  void WithLens(const Distortion& lens) {
    camera_.camera = {kWidth, kHeight, 50.0, 52.0, 30.0, 25.5};
    camera_.distortion = lens == Distortion() ? std::nullopt : std::optional(lens);
  }

  static std::vector<Eigen::Vector2d> ImagePointsIn(const LensCamera& camera,
                                                    const Rigid3d& world_from_camera,
                                                    const std::vector<Eigen::Vector3d>& points) {
    std::vector<Eigen::Vector2d> pixels;
    for (const Eigen::Vector3d& point : points) {
      pixels.push_back(*camera.camera.Project(world_from_camera.Inverse() * point));
    }
    return DistortPixels(camera.camera, camera.distortion.value_or(Distortion()), pixels);
  }

  // A model of the stored images, with these orientations.
  ColmapModel StoredModel(const std::vector<int>& orientations) {
    images_.clear();
    ColmapModel model;
    model.camera = camera_;
    for (const Eigen::Vector3d& point : points_) {
      model.points.push_back({model.points.size(), point, 0.0, 0.0, {}});
    }
    for (int i = 0; i < std::ssize(orientations); ++i) {
      const std::string name = std::to_string(i) + ".png";
      Write("rgb/" + name, PngWithExif(EncodedImage(".png", stored_), ExifOf(orientations[i]),
                                       /*is_after_pixels=*/false));
      images_.push_back({1.0 * i, "rgb/" + name});
      const Rigid3d pose{ExpRotation({0.05, -0.04, 0.3}), {0.1 * i, 0.05, -0.1}};
      ColmapImage image{i, 1, {"images.txt", name, pose}, ImagePointsIn(camera_, pose, points_)};
      for (int j = 0; j < std::ssize(points_); ++j) {
        model.points[j].track.push_back({i, j});
        const Eigen::Vector2i at = image.pixels[j].array().round().cast<int>();
        model.points[j].grey = stored_.at<uchar>(at.y(), at.x());
      }
      model.images.push_back(std::move(image));
    }
    return model;
  }

  void Turn(ColmapModel* model, ImageOrientation orientation = ImageOrientation::kUpright) const {
    TurnModel(images_, folder_.path(), orientation, model);
  }

  // Expects that points are where the images show them when EXIF has turned these.
  void ExpectUpright(const ColmapModel& model, const ColmapModel& stored,
                     const std::vector<int>& orientations) const {
    for (size_t i = 0; i < model.images.size(); ++i) {
      const ColmapImage& image = model.images[i];
      const auto projected = ImagePointsIn(model.camera, image.pose.world_from_camera, points_);
      for (size_t j = 0; j < points_.size(); ++j) {
        EXPECT_LT((projected[j] - image.pixels[j]).norm(), 1e-9);
        EXPECT_LT(
            (StoredPosition(orientations[i], image.pixels[j]) - stored.images[i].pixels[j]).norm(),
            1e-9);
      }
      EXPECT_EQ(image.pose.world_from_camera.translation,
                stored.images[i].pose.world_from_camera.translation);
    }
  }

  cv::Mat stored_ = cv::Mat(kHeight, kWidth, CV_8UC1);
  LensCamera camera_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<ListedImage> images_;
};

TEST_F(TurnModelTest, PointsAreSeenWhereTheUprightImagesShowThem) {
  const Distortion lenses[] = {{},                                                  // PINHOLE
                               {0.1},                                               // SIMPLE_RADIAL
                               {0.1, -0.05},                                        // RADIAL
                               {0.1, -0.05, 0.01, -0.02},                           // OPENCV
                               {0.1, -0.05, 0.01, -0.02, 0.01, 0.02, 0.03, 0.01}};  // FULL_OPENCV
  for (const Distortion& lens : lenses) {
    WithLens(lens);
    for (const int orientation : {1, 3, 6, 8}) {
      SCOPED_TRACE(testing::Message() << "k1 " << lens.k1 << ", orientation " << orientation);
      const std::vector<int> orientations = {orientation, orientation};
      const ColmapModel stored = StoredModel(orientations);
      ColmapModel model = stored;
      Turn(&model);
      EXPECT_EQ(model.camera.camera.width, orientation < 5 ? kWidth : kHeight);
      EXPECT_EQ(model.camera.camera.height, orientation < 5 ? kHeight : kWidth);
      EXPECT_TRUE(model.findings.empty());
      ExpectUpright(model, stored, orientations);
      EXPECT_EQ(model.camera == stored.camera, orientation == 1);
      ColmapModel back = stored;
      Turn(&back, ImageOrientation::kStored);
      EXPECT_EQ(back.camera, stored.camera);
      if (orientation < 6) continue;  // colours do not fit the turned model
      Turn(&model, ImageOrientation::kStored);
      ExpectUpright(model, stored, {1, 1});
    }
  }
}

TEST_F(TurnModelTest, TheWorldOfStoredImagesThatExifMirrorsIsMirrored) {
  for (const int orientation : {2, 4, 5, 7}) {
    ColmapModel model = StoredModel({orientation, orientation});
    for (const auto wanted : {ImageOrientation::kUpright, ImageOrientation::kStored}) {
      ExpectError<InputError>([&] { Turn(&model, wanted); },
                              {"0.png", "EXIF mirrors this image", "exiftran -ai"});
    }
  }
}

TEST_F(TurnModelTest, AModelOfUprightImagesStaysAsItIs) {
  for (const int orientation : {2, 3, 4, 5, 6, 7, 8}) {
    SCOPED_TRACE(orientation);
    ColmapModel model = StoredModel({orientation, orientation});
    Camera& camera = model.camera.camera;
    if (orientation >= 5) std::swap(camera.width, camera.height);
    for (ColmapImage& image : model.images) {
      for (size_t j = 0; j < points_.size(); ++j) {
        image.pixels[j] = image.pixels[j].array().round();
        const Eigen::Vector2d stored = StoredPosition(orientation, image.pixels[j]);
        if (orientation >= 5) continue;
        model.points[j].grey =
            stored_.at<uchar>(static_cast<int>(stored.y()), static_cast<int>(stored.x()));
      }
    }
    const ColmapModel before = model;
    Turn(&model);
    EXPECT_EQ(model.camera, before.camera);
    EXPECT_TRUE(model.findings.empty());
    for (size_t i = 0; i < model.images.size(); ++i) {
      EXPECT_EQ(model.images[i].pixels, before.images[i].pixels);
      EXPECT_EQ(model.images[i].pose.world_from_camera.rotation.coeffs(),
                before.images[i].pose.world_from_camera.rotation.coeffs());
    }
  }
}

TEST_F(TurnModelTest, PhotosThatExifTurnsInSeveralWaysHaveOneCameraIfItIsCentred) {
  camera_.camera = {kWidth, kHeight, 50.0, 52.0, 31.5, 23.5};
  for (const std::vector<int>& orientations : {std::vector{1, 3}, std::vector{6, 8}}) {
    const ColmapModel stored = StoredModel(orientations);
    ColmapModel model = stored;
    Turn(&model);
    EXPECT_TRUE(model.findings.empty());
    ExpectUpright(model, stored, orientations);
  }
  camera_.camera.cx += 0.25;
  ColmapModel model = StoredModel({6, 8});
  Turn(&model);
  EXPECT_EQ(Only(model.findings).check, "camera_per_image");
  EXPECT_EQ(model.camera.camera.cy, 31.5);
  camera_.camera.cx += 4.0;
  model = StoredModel({6, 8});
  ExpectError<InputError>([&] { Turn(&model); },
                          {"another camera", "4.2 px", "leave out the others"});
}

TEST_F(TurnModelTest, ItIsSaidIfColoursDoNotTell) {
  ColmapModel model = StoredModel({3, 3});
  const ColmapModel stored = model;
  for (ColmapPoint& point : model.points) point.grey = 0.0;
  Turn(&model);
  EXPECT_EQ(Only(model.findings).check, "model_orientation");
  ExpectUpright(model, stored, {3, 3});
  model.points.clear();
  model.camera.camera.width = 80;
  ExpectError<InputError>([&] { Turn(&model); },
                          {"0.png: is 64 x 48", "the model's camera 80 x 48"});
}

}  // namespace
}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/synthesis/render.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "soslam/synthesis/simulate.h"
#include "support/random.h"
#include "support/scene.h"

namespace soslam {
namespace {

const std::vector<Shape> kAllShapes = {Shape::kBox, Shape::kEllipsoid, Shape::kCylinder};

// One object ahead of a camera.
Scene OneObject(Shape shape, double yaw) {
  Scene scene;
  scene.name = "one";
  scene.camera = {320, 240, 260.0, 260.0, 159.5, 119.5};
  scene.planes.push_back({0, "floor", Plane{}, std::nullopt});
  scene.objects.push_back({1, "it", shape, {0.4, 0.3, 0.35}, {2.2, 0.1}, yaw, 0, 3});
  scene.trajectory.waypoints = {{{0.0, 0.0, 1.0}, {2.2, 0.0, 0.35}}};
  return scene;
}

cv::Mat Render(const Scene& scene) { return RenderFrame(scene, TruePoses(scene).front()); }

// Where the object's body changes the picture of the empty scene, more than its soft shadow does.
cv::Mat Silhouette(Scene scene) {
  const cv::Mat with_object = Render(scene);
  scene.objects.clear();
  cv::Mat difference, channels[3];
  cv::absdiff(with_object, Render(scene), difference);
  cv::split(difference, channels);
  // The patch colours can be near the floor's in one channel or another, not in all.
  return cv::max(channels[0], cv::max(channels[1], channels[2])) > 58;
}

TEST(SurfaceTexture, IsMirrorSymmetricInXzPlaneOnly) {
  for (const Shape shape : kAllShapes) {
    for (int seed = 0; seed < 5; ++seed) {
      const SceneObject object = {1, "it", shape, {0.4, 0.3, 0.35}, {0, 0}, 0.0, 0, seed};
      const SurfaceTexture texture(object);
      int yz_differs = 0, half_turn_differs = 0, quarter_turn_differs = 0, patches = 0;
      for (int i = 0; i < 2000; ++i) {
        const Eigen::Vector3d point =
            RandomVector(-1.0, 1.0).normalized().cwiseProduct(object.half_axes);
        const Eigen::Vector3d colour = texture.Colour(point);
        ASSERT_EQ(colour, texture.Colour({point.x(), -point.y(), point.z()}));
        yz_differs += colour != texture.Colour({-point.x(), point.y(), point.z()});
        half_turn_differs += colour != texture.Colour({-point.x(), -point.y(), point.z()});
        quarter_turn_differs += colour != texture.Colour({-point.y(), point.x(), point.z()});
        patches += colour.minCoeff() < 190.0;
      }
      EXPECT_GT(yz_differs, 300);
      EXPECT_GT(half_turn_differs, 300);
      EXPECT_GT(quarter_turn_differs, 300);
      EXPECT_GT(patches, 200);
      EXPECT_LT(patches, 1500);
    }
  }
}

TEST(RenderFrame, SilhouetteFillsTheExactBox) {
  for (const Shape shape : kAllShapes) {
    for (const double yaw : {0.3, 1.4, 2.6}) {
      const Scene scene = OneObject(shape, yaw);
      const cv::Rect found = cv::boundingRect(Silhouette(scene));
      const Box exact = Simulate(scene, false).exact_boxes.at(0).box;
      // Pixel edges of the silhouette against the outline; a pixel is found once enough of it is
      // covered.
      EXPECT_NEAR(found.x - 0.5, exact.x_min, 1.0);
      EXPECT_NEAR(found.y - 0.5, exact.y_min, 1.0);
      EXPECT_NEAR(found.x + found.width - 0.5, exact.x_max, 1.0);
      EXPECT_NEAR(found.y + found.height - 0.5, exact.y_max, 1.0);
    }
  }
}

TEST(RenderFrame, ShowsTheSurfaceColourUnderTheLight) {
  const Scene scene = OneObject(Shape::kEllipsoid, 0.5);
  const cv::Mat image = Render(scene);
  const Rigid3d world_from_camera = TruePoses(scene).front();
  const Landmark body = ObjectBody(scene, scene.objects[0]);
  const SurfaceTexture texture(scene.objects[0]);
  const auto colour_at = [&](double u, double v) -> std::optional<Eigen::Vector3d> {
    const Eigen::Vector3d ray = world_from_camera.rotation * scene.camera.Ray({u, v});
    const auto depth = NearestIntersection(body, world_from_camera.translation, ray);
    if (!depth) return std::nullopt;
    return texture.Colour(body.frame_from_object.Inverse() *
                          (world_from_camera.translation + *depth * ray));
  };
  int compared = 0;
  for (int v = 0; v < image.rows; v += 3) {
    for (int u = 0; u < image.cols; u += 3) {
      const auto colour = colour_at(u, v);
      const bool flat = colour && colour_at(u - 0.5, v - 0.5) == colour &&
                        colour_at(u + 0.5, v - 0.5) == colour &&
                        colour_at(u - 0.5, v + 0.5) == colour &&
                        colour_at(u + 0.5, v + 0.5) == colour;
      if (!flat) continue;
      ++compared;
      const cv::Vec3b pixel = image.at<cv::Vec3b>(v, u);
      const double light = (pixel[0] + pixel[1] + pixel[2]) / colour->sum();
      EXPECT_GT(light, 0.65);
      EXPECT_LT(light, 1.02);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(pixel[c], light * (*colour)[c], 1.5);
    }
  }
  EXPECT_GT(compared, 100);
}

TEST(RenderFrame, NearObjectHidesFarOne) {
  Scene scene = OneObject(Shape::kBox, 0.0);
  const cv::Mat alone = Render(scene);
  scene.objects.push_back({2, "behind", Shape::kBox, {0.2, 0.15, 0.1}, {3.2, 0.14}, 0.0, 0, 4});
  const cv::Rect box = cv::boundingRect(Silhouette(OneObject(Shape::kBox, 0.0)));
  // Ten pixels off the border of the near box nothing of the far one, nor of its shadow, shows.
  const cv::Rect middle(box.x + 10, box.y + 10, box.width - 20, box.height - 20);
  EXPECT_EQ(cv::norm(alone(middle), Render(scene)(middle), cv::NORM_INF), 0.0);
}

TEST(RenderFrame, TableIsDrawnUnderItsObjects) {
  Scene scene = OneObject(Shape::kBox, 0.0);
  scene.planes.push_back({1, "table", Plane{Eigen::Vector3d::UnitZ(), -0.3}, TableTop{}});
  scene.planes[1].table->position_on_plane = {2.2, 0.0};
  scene.planes[1].table->half_size = {0.5, 0.6};
  scene.planes[1].table->leg_length = 0.26;
  scene.objects.clear();
  const cv::Mat with_table = Render(scene);
  scene.planes.pop_back();
  const cv::Mat without = Render(scene);
  const auto pixel_of = [&](const Eigen::Vector3d& point_in_world) {
    const Eigen::Vector2d pixel =
        scene.camera.Project(TruePoses(scene).front().Inverse() * point_in_world).value();
    return cv::Point(static_cast<int>(std::lround(pixel.x())),
                     static_cast<int>(std::lround(pixel.y())));
  };
  const cv::Point top = pixel_of({2.2, 0.0, 0.3});
  const cv::Point beside = pixel_of({2.2, 0.8, 0.3});
  EXPECT_GT(cv::norm(with_table.at<cv::Vec3b>(top), without.at<cv::Vec3b>(top)), 20.0);
  EXPECT_EQ(with_table.at<cv::Vec3b>(beside), without.at<cv::Vec3b>(beside));
}

}  // namespace
}  // namespace soslam

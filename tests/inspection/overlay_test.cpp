// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/inspection/overlay.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "soslam/inspection/canvas.h"
#include "soslam/inspection/projection.h"
#include "support/exported_world.h"
#include "support/random.h"
#include "support/scene.h"

namespace soslam {
namespace {

const Camera kCamera = TestCamera();

// The overlay on a black image.
cv::Mat Drawn(const OverlayInput& input, int factor = 1) {
  cv::Mat image = cv::Mat::zeros(factor * kCamera.height, factor * kCamera.width, CV_8UC3);
  DrawOverlay(input, &image);
  return image;
}

// The rectangle of the pixels of this colour, or a darker one of thin lines; empty when there are
// none.
cv::Rect Where(const cv::Mat& image, const cv::Scalar& colour) {
  cv::Mat is_colour;
  cv::inRange(image, 0.6 * colour, colour, is_colour);
  return cv::boundingRect(is_colour);
}

// Lines are two pixels wide, their seams blend.
void ExpectAround(const cv::Rect& drawn, const Box& box, int factor = 1) {
  constexpr double kTolerancePx = 2.5;
  const auto place = [&](double pixel) { return factor * (pixel + 0.5) - 0.5; };
  EXPECT_NEAR(drawn.x, place(box.x_min), kTolerancePx);
  EXPECT_NEAR(drawn.y, place(box.y_min), kTolerancePx);
  EXPECT_NEAR(drawn.x + drawn.width - 1, place(box.x_max), kTolerancePx);
  EXPECT_NEAR(drawn.y + drawn.height - 1, place(box.y_max), kTolerancePx);
}

Landmark LandmarkInView(const ShapeExponents& shape_exponents) {
  Landmark landmark{{ExpRotation({0.3, -0.7, 0.4}), {0.1, -0.2, 4.0}}, {0.5, 0.3, 0.7}};
  landmark.shape_exponents = shape_exponents;
  return landmark;
}

TEST(OverlayTest, OutlinesOfAllShapesFillTheirOutlineBox) {
  for (const double exponent : {1.0, 1.3, 2.0}) {
    const Landmark landmark = LandmarkInView(exponent);
    for (const int factor : {1, 3}) {
      const cv::Mat image = Drawn({.camera = kCamera, .landmarks = {{landmark, ""}}}, factor);
      ExpectAround(Where(image, palette::kSkyBlue), *OutlineBox(kCamera, landmark), factor);
    }
  }
}

TEST(OverlayTest, TheTruthIsDrawnAsTheBoxAroundIt) {
  const cv::Mat image = Drawn({.camera = kCamera, .truths_in_camera = {{LandmarkInView(2.0)}}});
  ExpectAround(Where(image, palette::kVermilion), *OutlineBox(kCamera, LandmarkInView(1.0)));
}

TEST(OverlayTest, DetectionsAreDrawnWithTheirCaption) {
  const Box box{100.0, 150.0, 300.0, 350.0};
  ExpectAround(Where(Drawn({.camera = kCamera, .detections = {{box, ""}}}), palette::kYellow), box);
  const cv::Mat captioned = Drawn({.camera = kCamera, .detections = {{box, "cup \xc3\xa4"}}});
  const cv::Mat above = captioned.rowRange(120, 145);
  EXPECT_GT(cv::countNonZero(above.reshape(1)), 0);
}

// An arrow leads from the centre to the front; without a front the x axis is drawn both ways.
TEST(OverlayTest, FrontsAreDrawnWhereTheyAreKnown) {
  const Landmark landmark{{Eigen::Quaterniond::Identity(), {0.0, 0.0, 4.0}}, {1.0, 0.5, 0.5}};
  const auto is_drawn = [&](const OverlayInput& input, const cv::Scalar& colour, double x) {
    const cv::Mat image = Drawn(input);
    const Eigen::Vector2d pixel = *kCamera.Project({x, 0.0, 4.0});
    const cv::Rect near(static_cast<int>(pixel.x()) - 2, static_cast<int>(pixel.y()) - 2, 5, 5);
    return !Where(image(near), colour).empty();
  };
  for (const bool has_front : {true, false}) {
    const OverlayInput truth{.camera = kCamera, .truths_in_camera = {{landmark, has_front}}};
    EXPECT_TRUE(is_drawn(truth, palette::kVermilion, 0.8));
    EXPECT_NE(is_drawn(truth, palette::kVermilion, -0.8), has_front);
    const OverlayInput estimate{.camera = kCamera,
                                .landmarks = {{landmark, "", has_front ? "front 97 %" : ""}}};
    EXPECT_TRUE(is_drawn(estimate, palette::kSkyBlue, 0.8));
    EXPECT_NE(is_drawn(estimate, palette::kSkyBlue, -0.8), has_front);
    EXPECT_EQ(OverlayLegend(estimate)[0].text.find("arrow") != std::string::npos, has_front);
  }
}

TEST(OverlayTest, WhatIsBehindTheCameraIsNotDrawn) {
  Landmark behind = LandmarkInView(1.0);
  behind.frame_from_object.translation.z() = -4.0;
  const cv::Mat image =
      Drawn({.camera = kCamera, .truths_in_camera = {{behind}}, .landmarks = {{behind, "x", "y"}}});
  EXPECT_EQ(cv::countNonZero(image.reshape(1)), 0);
}

// One object is in the image, one beside it, and one has no landmark.
TEST(OverlayTest, OfAWorldHasTheBodiesInTheImage) {
  World world = ExportedWorld();
  world.objects.erase(world.objects.begin() + 1);
  world.objects[0].estimate.front_probability = 0.97;
  world.objects[1].estimate.landmark_in_world->frame_from_object.translation.x() += 50.0;
  const WorldFrame& frame = world.frames[1];
  const OverlayInput input = OverlayOfWorld(world, frame);
  EXPECT_EQ(input.camera, frame.camera);
  ASSERT_EQ(input.landmarks.size(), 1u);
  EXPECT_EQ(input.landmarks[0].caption, "2 Dining_Table");
  EXPECT_EQ(input.landmarks[0].front_caption, "front 97 %");
  EXPECT_LT((frame.world_from_camera * input.landmarks[0].landmark_in_camera.Centre() -
             world.objects[0].estimate.landmark_in_world->Centre())
                .norm(),
            1e-12);
  EXPECT_TRUE(OverlayOfWorld(world, world.frames[2]).landmarks.empty()) << "it looks away";
}

class OverlayOfSceneTest : public testing::Test {
 protected:
  Sequence sequence_ = SyntheticSequence(RandomScene(1, 3, 6, {Shape::kEllipsoid}), false);
};

TEST_F(OverlayOfSceneTest, TheTruthFillsExactDetections) {
  int boxes = 0;
  for (int i = 0; i < static_cast<int>(sequence_.frames.size()); ++i) {
    const OverlayInput input = OverlayOfFrame(sequence_, i);
    ASSERT_EQ(input.truths_in_camera.size(), input.detections.size());
    EXPECT_EQ(input.grounds.empty(), input.detections.empty());
    for (size_t k = 0; k < input.detections.size(); ++k, ++boxes) {
      const Landmark& truth = input.truths_in_camera[k].landmark_in_camera;
      EXPECT_LT(OutlineEdgeRms(input.camera, truth, input.detections[k].box), 1e-6);
    }
  }
  EXPECT_EQ(boxes, static_cast<int>(sequence_.detections.size()));
}

// Lines of the grid are on the plane: feet that are 10 m apart have cells of 1 m between them.
TEST(OverlayTest, GridsOfPlanesReachAroundTheFeet) {
  const Plane floor{-Eigen::Vector3d::UnitY(), 1.0};
  const OverlayInput input{.camera = kCamera,
                           .grounds = {{floor, {{-5.0, 1.0, 12.0}, {5.0, 1.0, 12.0}}}}};
  cv::Mat grey;
  cv::cvtColor(Drawn(input), grey, cv::COLOR_BGR2GRAY);
  const cv::Rect drawn = cv::boundingRect(grey > 60);
  EXPECT_NEAR(drawn.y, kCamera.Project({0.0, 1.0, 13.0})->y(), 2.0);
  EXPECT_NEAR(drawn.y + drawn.height - 1, kCamera.Project({0.0, 1.0, 11.0})->y(), 2.0);
  EXPECT_NE(OverlayLegend(input).at(0).text.find("cells of 1 m"), std::string::npos);
}

constexpr int kSize = kPictureWidth;  // so that pictures are not enlarged

// One vertical edge in the middle, and a corner.
EdgeMaps MapsOfAnEdge() {
  EdgeMaps maps;
  maps.grey = cv::Mat(kSize, kSize, CV_8UC1, cv::Scalar(50));
  maps.edges = cv::Mat::zeros(kSize, kSize, CV_8UC1);
  maps.edges.col(kSize / 2) = 255;
  maps.distance = cv::Mat(kSize, kSize, CV_32FC1);
  maps.nearest_edge = cv::Mat(kSize, kSize, CV_16SC2);
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      maps.distance.at<float>(y, x) = static_cast<float>(std::abs(x - kSize / 2));
      maps.nearest_edge.at<cv::Vec2s>(y, x) = {kSize / 2, static_cast<short>(y)};
    }
  }
  maps.corners = {{100.0F, 200.0F}};
  return maps;
}

// Blue, green, red at (x, y).
cv::Vec3b At(const cv::Mat& picture, int x, int y) { return picture.at<cv::Vec3b>(y, x); }

int Brightness(const cv::Vec3b& colour) { return colour[0] + colour[1] + colour[2]; }

TEST(PicturesTest, EveryLayerShowsItsMap) {
  const EdgeMaps maps = MapsOfAnEdge();
  const auto picture = [&](EdgeLayer layer) { return EdgesPicture(maps, layer, "frame 1"); };
  const cv::Mat grey = picture(EdgeLayer::kGrey);
  EXPECT_EQ(At(grey, 10, 10), cv::Vec3b(50, 50, 50));
  EXPECT_EQ(At(grey, 100, 200), cv::Vec3b(66, 228, 240)) << "the corner";
  const cv::Mat edges = picture(EdgeLayer::kEdges);
  EXPECT_EQ(At(edges, kSize / 2, 10), cv::Vec3b(255, 255, 255));
  EXPECT_EQ(At(edges, 10, 10), cv::Vec3b(0, 0, 0));
  const cv::Mat distance = picture(EdgeLayer::kDistance);
  EXPECT_GT(Brightness(At(distance, 0, 10)), Brightness(At(distance, kSize / 2, 10)) + 100);
  const cv::Mat nearest = picture(EdgeLayer::kNearest);
  EXPECT_GT(At(nearest, 10, 10)[2], At(nearest, 10, 10)[0]) << "red: the edge is to the right";
  EXPECT_LT(At(nearest, kSize - 10, 10)[2], At(nearest, kSize - 10, 10)[0]) << "cyan: to the left";
  EXPECT_GT(nearest.rows, kSize) << "there is a caption";
}

TEST(PicturesTest, PairsAreJoinedOnThePartAroundThem) {
  SymmetryRecord record;
  record.samples = {{300.0F, 400.0F}};
  record.mirrored = {{360.0F, 400.0F}};
  const cv::Mat image(kSize, kSize, CV_8UC3, cv::Scalar(0, 0, 0));
  const cv::Mat picture = SymmetryPicture(record, image, "frame 1, object 2");
  // 61 pixels with 24 on both sides are enlarged to the width of a picture.
  const int factor = (kSize + 108) / 109;
  EXPECT_EQ(picture.cols, 109 * factor);
  const int y = static_cast<int>(24.5 * factor);
  EXPECT_EQ(At(picture, static_cast<int>(24.5 * factor), y), cv::Vec3b(66, 228, 240));
  EXPECT_EQ(At(picture, static_cast<int>(84.5 * factor), y), cv::Vec3b(233, 180, 86));
  EXPECT_GT(Brightness(At(picture, static_cast<int>(54.5 * factor), y)), 60) << "the line";
}

// Shoelace formula.
double Area(const Polygon& polygon) {
  double twice = 0.0;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& next = polygon[(i + 1) % polygon.size()];
    twice += polygon[i].x() * next.y() - next.x() * polygon[i].y();
  }
  return std::abs(twice) / 2.0;
}

// A sphere straight ahead is a disc of radius f tan(asin(r / d)). The polygon is half a pixel off
// at most, over a rim of 540 px.
TEST(OutlinePolygon, OfASphereIsADisc) {
  Camera camera = TestCamera();
  camera.fy = camera.fx;
  const Landmark sphere{{Eigen::Quaterniond::Identity(), {0.0, 0.0, 4.0}},
                        Eigen::Vector3d::Constant(0.6)};
  const double radius = camera.fx * std::tan(std::asin(0.6 / 4.0));
  const Polygon outline = OutlinePolygon(camera, sphere);
  EXPECT_NEAR(Area(outline), std::numbers::pi * radius * radius,
              2.0 * std::numbers::pi * radius * 0.5);
  for (const Eigen::Vector2d& pixel : outline) {
    EXPECT_NEAR((pixel - Eigen::Vector2d(camera.cx, camera.cy)).norm(), radius, 1e-3);
  }
}

TEST(OutlinePolygon, OfACuboidInFrontIsItsNearFace) {
  const Camera camera = TestCamera();
  const Landmark cuboid{
      {Eigen::Quaterniond::Identity(), {0.0, 0.0, 5.0}}, {0.5, 0.4, 1.0}, kCuboidExponent};
  const Polygon outline = OutlinePolygon(camera, cuboid);
  ASSERT_EQ(outline.size(), 4u);
  EXPECT_NEAR(Area(outline), (2.0 * 0.5 * camera.fx / 4.0) * (2.0 * 0.4 * camera.fy / 4.0), 1.0);
}

TEST(ProjectSegment, EndsWhereTheCameraIs) {
  const Camera camera = TestCamera();
  const LineSegment3 through{Eigen::Vector3d(0.3, 0.2, -1.0), Eigen::Vector3d(0.3, 0.2, 3.0)};
  const auto visible = ProjectSegment(camera, through);
  ASSERT_TRUE(visible);
  EXPECT_EQ((*visible)[1], *camera.Project(through[1]));
  // On the same line of the image, beyond its far end.
  const Eigen::Vector2d centre(camera.cx, camera.cy);
  const Eigen::Vector2d near = (*visible)[0] - centre;
  const Eigen::Vector2d far = (*visible)[1] - centre;
  EXPECT_NEAR(near.x() * far.y() - near.y() * far.x(), 0.0, 1e-6 * near.norm() * far.norm());
  EXPECT_GT(near.norm(), far.norm());
  EXPECT_FALSE(ProjectSegment(camera, {Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(1, 0, -2)}));
}

TEST(GridAround, IsOnThePlaneAroundThePoints) {
  for (const double extent : {0.2, 3.0, 60.0}) {
    const Plane plane = RandomPlane();
    const Rigid3d frame_from_plane = {UprightRotation(plane.normal, 0.0),
                                      -plane.offset * plane.normal};
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < 5; ++i) {
      points.push_back(frame_from_plane * RandomVector(-extent, extent));
    }
    const auto lines = GridAround(plane, points).lines;
    EXPECT_LE(lines.size(), static_cast<size_t>(2 * (kMaxGridLines + 2)));
    Eigen::Array2d low(1e9, 1e9), high(-1e9, -1e9);
    for (const LineSegment3& line : lines) {
      for (const Eigen::Vector3d& end : line) {
        EXPECT_NEAR(plane.SignedDistance(end), 0.0, 1e-9);
        const Eigen::Array2d place = (frame_from_plane.Inverse() * end).head<2>().array();
        low = low.min(place);
        high = high.max(place);
      }
    }
    for (const Eigen::Vector3d& point : points) {
      const Eigen::Array2d place = (frame_from_plane.Inverse() * point).head<2>().array();
      EXPECT_TRUE((place >= low).all() && (place <= high).all());
    }
  }
}

}  // namespace
}  // namespace soslam

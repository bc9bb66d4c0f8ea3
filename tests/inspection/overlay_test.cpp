// SPDX-License-Identifier: BSD-3-Clause
#include "inspection/overlay.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "support/random.h"
#include "support/scene.h"
#include "support/true_map.h"
#include "synthesis/simulate.h"

namespace soslam {
namespace {

const Camera kCamera = TestCamera();

cv::Mat Black(int factor = 1) {
  return cv::Mat::zeros(factor * kCamera.height, factor * kCamera.width, CV_8UC3);
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

Landmark LandmarkInView(double shape_exponent) {
  Landmark landmark{{ExpRotation({0.3, -0.7, 0.4}), {0.1, -0.2, 4.0}}, {0.5, 0.3, 0.7}};
  landmark.shape_exponent = shape_exponent;
  return landmark;
}

TEST(OverlayTest, OutlinesOfAllShapesFillTheirOutlineBox) {
  for (const double exponent : {1.0, 1.3, 2.0}) {
    const Landmark landmark = LandmarkInView(exponent);
    for (const int factor : {1, 3}) {
      cv::Mat image = Black(factor);
      DrawOverlay({.camera = kCamera, .landmarks = {{landmark, ""}}}, &image);
      ExpectAround(Where(image, palette::kSkyBlue), *OutlineBox(kCamera, landmark), factor);
    }
  }
}

TEST(OverlayTest, TheTruthIsDrawnAsTheBoxAroundIt) {
  cv::Mat image = Black();
  DrawOverlay({.camera = kCamera, .truths_in_camera = {LandmarkInView(2.0)}}, &image);
  ExpectAround(Where(image, palette::kVermilion), *OutlineBox(kCamera, LandmarkInView(1.0)));
}

TEST(OverlayTest, DetectionsAreDrawnWithTheirCaption) {
  const Box box{100.0, 150.0, 300.0, 350.0};
  cv::Mat image = Black();
  DrawOverlay({.camera = kCamera, .detections = {{box, ""}}}, &image);
  ExpectAround(Where(image, palette::kYellow), box);
  cv::Mat captioned = Black();
  DrawOverlay({.camera = kCamera, .detections = {{box, "cup \xc3\xa4"}}}, &captioned);
  const cv::Mat above = captioned.rowRange(120, 145);
  EXPECT_GT(cv::countNonZero(above.reshape(1)), 0);
}

// The arrow is where the object's x axis ends, nothing is where its -x axis does.
TEST(OverlayTest, TheArrowShowsTheFront) {
  const Landmark landmark{{Eigen::Quaterniond::Identity(), {0.0, 0.0, 4.0}}, {1.0, 0.5, 0.5}};
  cv::Mat image = Black();
  DrawOverlay({.camera = kCamera, .landmarks = {{landmark, ""}}}, &image);
  const auto is_drawn = [&](double x) {
    const Eigen::Vector2d pixel = *kCamera.Project({x, 0.0, 4.0});
    const cv::Rect near(static_cast<int>(pixel.x()) - 2, static_cast<int>(pixel.y()) - 2, 5, 5);
    return !Where(image(near), palette::kSkyBlue).empty();
  };
  EXPECT_TRUE(is_drawn(0.8));
  EXPECT_FALSE(is_drawn(-0.8));
}

TEST(OverlayTest, WhatIsBehindTheCameraIsNotDrawn) {
  Landmark behind = LandmarkInView(1.0);
  behind.frame_from_object.translation.z() = -4.0;
  cv::Mat image = Black();
  DrawOverlay({.camera = kCamera, .truths_in_camera = {behind}, .landmarks = {{behind, "x"}}},
              &image);
  EXPECT_EQ(cv::countNonZero(image.reshape(1)), 0);
}

// Some of a body is beside or behind the camera: its box is cut off there.
TEST(OverlayTest, WhatReachesBehindTheCameraIsCutOff) {
  const Landmark around{{Eigen::Quaterniond::Identity(), {0.0, 0.5, 1.0}}, {0.3, 0.2, 3.0}};
  cv::Mat image = Black();
  DrawOverlay({.camera = kCamera, .truths_in_camera = {around}}, &image);
  EXPECT_FALSE(Where(image, palette::kVermilion).empty());
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
      EXPECT_LT(OutlineEdgeRms(input.camera, input.truths_in_camera[k], input.detections[k].box),
                1e-6);
    }
  }
  EXPECT_EQ(boxes, static_cast<int>(sequence_.detections.size()));
}

TEST_F(OverlayOfSceneTest, TheBestHypothesisOfEachObservationIsShown) {
  LandmarkEstimates estimates;
  for (int i = 0; i < static_cast<int>(sequence_.detections.size()); ++i) {
    const auto truth = TrueLandmarkInCamera(sequence_, sequence_.detections[i]);
    estimates.observations.push_back({i, {{*truth, 0.0}, {LandmarkInView(1.0), 1.0}}, ""});
  }
  const int frame_index = sequence_.detections.front().frame_index;
  const OverlayInput input = OverlayOfLandmarks(sequence_, estimates, frame_index);
  ASSERT_EQ(input.landmarks.size(), input.detections.size());
  EXPECT_EQ(input.landmarks[0].landmark_in_camera.Centre(), input.truths_in_camera[0].Centre());
}

TEST_F(OverlayOfSceneTest, ObjectsThatAreNotDetectedHaveCaptions) {
  const MapEstimate map = TrueMap(sequence_);
  const Detection missed = sequence_.detections.front();
  sequence_.detections.erase(sequence_.detections.begin());
  const OverlayInput input = OverlayOfMap(sequence_, map, missed.frame_index);
  const Object& object = sequence_.ObjectOf(missed);
  int captions = 0;
  for (const auto& body : input.landmarks) {
    if (body.caption.empty()) continue;
    ++captions;
    EXPECT_EQ(body.caption, std::to_string(object.id) + " " + object.label);
    EXPECT_LT(OutlineEdgeRms(input.camera, body.landmark_in_camera, missed.box), 1e-6);
  }
  EXPECT_EQ(captions, 1);
}

// Lines of the grid are on the plane: feet that are 10 m apart have cells of 1 m between them.
TEST(OverlayTest, GridsOfPlanesReachAroundTheFeet) {
  const Plane floor{-Eigen::Vector3d::UnitY(), 1.0};
  const OverlayInput input{.camera = kCamera,
                           .grounds = {{floor, {{-5.0, 1.0, 12.0}, {5.0, 1.0, 12.0}}}}};
  cv::Mat image = Black();
  DrawOverlay(input, &image);
  cv::Mat grey;
  cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  const cv::Rect drawn = cv::boundingRect(grey > 60);
  EXPECT_NEAR(drawn.y, kCamera.Project({0.0, 1.0, 13.0})->y(), 2.0);
  EXPECT_NEAR(drawn.y + drawn.height - 1, kCamera.Project({0.0, 1.0, 11.0})->y(), 2.0);
  EXPECT_NE(OverlayLegend(input).at(0).text.find("cells of 1 m"), std::string::npos);
}

}  // namespace
}  // namespace soslam

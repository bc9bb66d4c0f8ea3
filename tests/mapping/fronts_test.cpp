// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/mapping/fronts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "soslam/geometry/angles.h"
#include "soslam/mapping/back_end.h"
#include "support/cuboid_map.h"
#include "support/one_body.h"
#include "support/pictures.h"

namespace soslam::fronts {
namespace {

Landmark BodyAt(double yaw) {
  Landmark body;
  body.shape_exponents = kEllipsoidExponent;
  body.half_axes = {0.3, 0.3, 0.4};
  body.frame_from_object = {UprightRotation(Eigen::Vector3d::UnitZ(), yaw), {0.1, -0.2, 0.4}};
  return body;
}

double ComputeYaw(const Landmark& landmark) {
  return Yaw(Eigen::Vector3d::UnitZ(), landmark.frame_from_object.rotation);
}

// One chair of which pictures tell the front, in a map.
class FaceFrontTest : public testing::Test {
 protected:
  FaceFrontTest() {
    AddTruePictures(&sequence_);
    prior_.has_front = true;
    object_.landmark_in_world = truth_;
  }
  ObjectEstimate Faced() const {
    MapEstimate map;
    map.objects = {object_};
    FaceFront(sequence_, {prior_}, &map);
    return map.objects[0];
  }
  // Expects the landmark as it was, and nothing said of its front.
  void ExpectUntouched() const {
    const ObjectEstimate faced = Faced();
    EXPECT_FALSE(faced.front_probability);
    EXPECT_EQ(ComputeYaw(*faced.landmark_in_world), ComputeYaw(*object_.landmark_in_world));
  }

  Landmark truth_ = BodyAt(0.7);
  Sequence sequence_ = ViewsOfBody(truth_, CamerasOnArc(5, 1.5));
  ShapePrior prior_;
  ObjectEstimate object_;
};

TEST_F(FaceFrontTest, KeepsAFrontThatPicturesAgreeWith) {
  const ObjectEstimate faced = Faced();
  EXPECT_GT(faced.front_probability.value(), 0.99);
  EXPECT_EQ(ComputeYaw(*faced.landmark_in_world), ComputeYaw(truth_));
}

TEST_F(FaceFrontTest, TurnsABodyThatShowsItsBack) {
  const double probability = Faced().front_probability.value();
  object_.landmark_in_world = RotatedAboutZ(truth_, std::numbers::pi);
  const ObjectEstimate faced = Faced();
  EXPECT_NEAR(faced.front_probability.value(), probability, 1e-9);
  EXPECT_NEAR(ComputeYaw(*faced.landmark_in_world), ComputeYaw(truth_), 1e-9);
  EXPECT_EQ(faced.landmark_in_world->half_axes, truth_.half_axes);
  EXPECT_LT((faced.landmark_in_world->Centre() - truth_.Centre()).norm(), 1e-12);
  EXPECT_NEAR(BoxIou(*faced.landmark_in_world, *object_.landmark_in_world), 1.0, 1e-6);
}

TEST_F(FaceFrontTest, AQuarterTurnThatIsPossibleMakesTheFrontLessSure) {
  const double probability = Faced().front_probability.value();
  object_.quarter_turn = 0.3;
  EXPECT_NEAR(Faced().front_probability.value(), 0.7 * probability, 1e-9);
}

TEST_F(FaceFrontTest, SaysNothingWhereThereIsNoFront) {
  prior_.has_front = false;
  ExpectUntouched();
  prior_.has_front = true;
  object_.landmark_in_world->rests_on = RestingFace::kBack;
  ExpectUntouched();
  object_.landmark_in_world = truth_;
  for (Detection& detection : sequence_.detections) detection.appearance = nullptr;
  ExpectUntouched();
}

TEST_F(FaceFrontTest, SaysNothingOfObjectsWithoutLandmark) {
  object_.landmark_in_world.reset();
  EXPECT_FALSE(Faced().front_probability);
  EXPECT_FALSE(Faced().landmark_in_world);
}

TEST(OptimiseMap, PicturesTurnABodyThatBoxesLeaveFree) {
  for (const double start : {-0.5, 0.3, 3.5}) {
    Sequence sequence = ViewsOfBody(BodyAt(0.7), CamerasOnArc(6, 2.0));
    AddTruePictures(&sequence);
    BackEndInput input = TruthInput(sequence);
    input.initial_landmarks[0] = BodyAt(0.7 + start);
    OptimiseOptions options = TangencyOptions();
    options.hold_poses = true;
    const MapEstimate map = OptimiseMap(input, options);
    const double yaw = ComputeYaw(*map.objects[0].landmark_in_world);
    EXPECT_LT(std::abs(YawDifferenceModuloPi(yaw, 0.7)), 2.5 * kRadPerDeg) << start;
  }
}

}  // namespace
}  // namespace soslam::fronts

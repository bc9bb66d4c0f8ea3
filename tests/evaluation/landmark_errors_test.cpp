// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/evaluation/landmark_errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "soslam/geometry/angles.h"
#include "soslam/geometry/rigid3.h"
#include "support/random.h"

namespace soslam {
namespace {

constexpr double kPi = std::numbers::pi;

// On the plane z = 0.
Landmark Standing(double x, double y, double yaw_deg, const Eigen::Vector3d& half_axes) {
  Landmark landmark;
  landmark.frame_from_object = {ExpRotation({0, 0, kRadPerDeg * yaw_deg}), {x, y, half_axes.z()}};
  landmark.half_axes = half_axes;
  return landmark;
}

const Eigen::Vector3d kCamera(0.0, -4.0, 1.5);

ObjectEstimate WithFront(double yaw_deg, std::optional<double> front_probability) {
  ObjectEstimate estimate;
  estimate.landmark_in_world = Standing(1.0, 2.0, yaw_deg, {0.4, 0.2, 0.3});
  estimate.front_probability = front_probability;
  return estimate;
}

FrontError FrontErrorOf(const ObjectEstimate& estimate, const GroundTruth& truth) {
  return CompareFronts(estimate, *estimate.landmark_in_world, truth);
}

TEST(CompareFrontsTest, ErrorsAreOverTheFullCircle) {
  const GroundTruth truth{Standing(1.0, 2.0, 20.0, {0.4, 0.2, 0.3})};
  for (const double turn_deg : {0.0, 30.0, 90.0, 135.0, 179.0, -60.0, -150.0}) {
    const FrontError front = FrontErrorOf(WithFront(20.0 + turn_deg, 0.95), truth);
    EXPECT_NEAR(front.deg.value(), std::abs(turn_deg), 1e-9);
    EXPECT_TRUE(front.is_known);
  }
  EXPECT_FALSE(FrontErrorOf(WithFront(20.0, 0.6), truth).is_known);
}

TEST(CompareFrontsTest, ThereIsNoErrorWithoutFronts) {
  const GroundTruth truth{Standing(1.0, 2.0, 20.0, {0.4, 0.2, 0.3})};
  EXPECT_FALSE(FrontErrorOf(WithFront(20.0, std::nullopt), truth).deg);
  GroundTruth round = truth, alike = truth, lying = truth;
  round.rotationally_symmetric = true;
  alike.mirror_symmetric_yz = true;
  lying.landmark_in_world.rests_on = RestingFace::kBack;
  for (const GroundTruth& without : {round, alike, lying}) {
    const FrontError front = FrontErrorOf(WithFront(20.0, 0.95), without);
    EXPECT_FALSE(front.deg);
    EXPECT_FALSE(front.is_known);
  }
}

TEST(SummariseFrontsTest, KnownOnesThatAreWrongAreCounted) {
  EXPECT_FALSE(SummariseFronts({{}, {}}));
  const FrontSummary fronts =
      SummariseFronts({{10.0, true}, {}, {30.0, false}, {45.0, true}, {175.0, true}}).value();
  EXPECT_EQ(fronts.objects, 4);
  EXPECT_EQ(fronts.deg_mean, 65.0);
  EXPECT_EQ(fronts.deg_median, 37.5);
  EXPECT_EQ(fronts.share_below_30_deg, 0.25);
  EXPECT_EQ(fronts.known, 3);
  EXPECT_EQ(fronts.known_but_wrong, 1);
}

class BodyErrorsTest : public testing::Test {
 protected:
  BodyErrors Compare(const Landmark& estimate) const {
    return CompareBodies(estimate, truth_, truth_.landmark_in_world);
  }
  std::optional<WrongPart> Wrong(const Landmark& estimate) const {
    return FindDominantError(estimate, truth_, truth_.landmark_in_world, kCamera);
  }
  GroundTruth truth_{Standing(1.0, 2.0, 20.0, {0.4, 0.2, 0.3})};
};

TEST_F(BodyErrorsTest, NominalNumbers) {
  const BodyErrors errors = Compare(Standing(1.0, 2.3, 30.0, {0.8, 0.2, 0.3}));
  EXPECT_NEAR(errors.centre_m, 0.3, 1e-12);
  EXPECT_NEAR(errors.centre_relative, 0.3 / (2.0 * std::cbrt(0.024)), 1e-12);
  EXPECT_NEAR(errors.log_size.x(), std::log(2.0), 1e-12);
  EXPECT_NEAR(errors.log_size.tail<2>().norm(), 0.0, 1e-12);
  EXPECT_NEAR(errors.log_scale, std::log(2.0) / 3.0, 1e-12);
  EXPECT_NEAR(errors.yaw_deg.value(), 10.0, 1e-9);
  EXPECT_NEAR(errors.up_deg, 0.0, 1e-6);
  EXPECT_FALSE(errors.is_quarter_turned);
}

TEST_F(BodyErrorsTest, ABodyWithOtherNamesOfItsAxesIsTheSame) {
  const BodyErrors turned = Compare(Standing(1.0, 2.0, 110.0, {0.2, 0.4, 0.3}));
  EXPECT_NEAR(turned.iou, 1.0, 1e-9);
  EXPECT_NEAR(turned.log_size.norm(), 0.0, 1e-12);
  EXPECT_NEAR(turned.yaw_deg.value(), 0.0, 1e-6);
  EXPECT_TRUE(turned.is_quarter_turned);
  EXPECT_NEAR(Compare(Standing(1.0, 2.0, 200.0, {0.4, 0.2, 0.3})).yaw_deg.value(), 0.0, 1e-6);
  // Its z axis is the true y axis, so it lies.
  Landmark lying = truth_.landmark_in_world;
  lying.frame_from_object.rotation =
      lying.frame_from_object.rotation * ExpRotation({kPi / 2, 0, 0});
  lying.half_axes = {0.4, 0.3, 0.2};
  EXPECT_NEAR(Compare(lying).iou, 1.0, 1e-9);
  EXPECT_NEAR(Compare(lying).log_size.norm(), 0.0, 1e-12);
  EXPECT_NEAR(Compare(lying).up_deg, 90.0, 1e-6);
}

TEST_F(BodyErrorsTest, ThePartThatIsWrongIsFound) {
  struct Case {
    BodyPart part;
    Landmark estimate;
  };
  Landmark tilted = truth_.landmark_in_world;
  tilted.frame_from_object.rotation = ExpRotation({0, 0.5, 0}) * tilted.frame_from_object.rotation;
  tilted.frame_from_object.translation =
      Eigen::Vector3d(1.0, 2.0, 0.0) +
      tilted.frame_from_object.rotation * Eigen::Vector3d(0.0, 0.0, 0.3);
  Landmark high = truth_.landmark_in_world;
  high.frame_from_object.translation.z() += 0.4;
  const std::vector<Case> cases = {{BodyPart::kPlane, high},
                                   {BodyPart::kPlane, tilted},
                                   {BodyPart::kSize, Standing(1.0, 2.0, 20.0, {0.5, 0.5, 0.6})},
                                   {BodyPart::kYaw, Standing(1.0, 2.0, 60.0, {0.4, 0.2, 0.3})},
                                   {BodyPart::kPlace, Standing(1.3, 2.2, 20.0, {0.4, 0.2, 0.3})}};
  for (const auto& [part, estimate] : cases) {
    const auto wrong = Wrong(estimate);
    ASSERT_TRUE(wrong);
    EXPECT_EQ(wrong->part, part);
    EXPECT_NEAR(wrong->iou, 1.0, 1e-6);
    EXPECT_GT(wrong->iou, Compare(estimate).iou);
  }
}

TEST_F(BodyErrorsTest, NoPartIsToBlameWhereNoneAloneHelps) {
  EXPECT_FALSE(Wrong(truth_.landmark_in_world));
  Landmark far_and_high = Standing(7.0, 2.0, 20.0, {0.4, 0.2, 0.3});
  far_and_high.frame_from_object.translation.z() += 5.0;
  EXPECT_FALSE(Wrong(far_and_high));
}

// A plane that is too low puts what stands on it farther away and makes it larger.
TEST_F(BodyErrorsTest, APlaneThatIsTooLowIsSeenInDistanceAndSize) {
  constexpr double kFactor = 1.3;
  Landmark estimate = truth_.landmark_in_world;
  estimate.half_axes *= kFactor;
  estimate.frame_from_object.translation = kCamera + kFactor * (estimate.Centre() - kCamera);
  const auto wrong = Wrong(estimate);
  ASSERT_TRUE(wrong);
  EXPECT_EQ(wrong->part, BodyPart::kPlane);
  EXPECT_NEAR(wrong->iou, 1.0, 1e-9);
}

// The true body is 0.8 m by 0.4 m, all of the same height.
class WhatIfTest : public BodyErrorsTest {
 protected:
  // The errors of an estimate, seen by a camera anywhere.
  LandmarkErrors Errors(const Landmark& estimate) const {
    const Rigid3d camera_from_world = RandomRigid();
    return CompareInCamera(Transform(camera_from_world, estimate), truth_,
                           Transform(camera_from_world, truth_.landmark_in_world));
  }
  void ExpectIous(const Landmark& estimate, double iou, const WhatIf& expected) const {
    const LandmarkErrors errors = Errors(estimate);
    EXPECT_NEAR(errors.iou, iou, 1e-9);
    EXPECT_NEAR(errors.what_if->yaw, expected.yaw, 1e-9);
    EXPECT_NEAR(errors.what_if->quarter_turn, expected.quarter_turn, 1e-9);
    EXPECT_NEAR(errors.what_if->place, expected.place, 1e-9);
    EXPECT_NEAR(errors.what_if->size, expected.size, 1e-9);
  }
  // The true body, moved along its own x axis.
  Landmark MovedAlongX(double distance) const {
    Landmark moved = truth_.landmark_in_world;
    moved.frame_from_object.translation +=
        moved.frame_from_object.rotation * Eigen::Vector3d(distance, 0.0, 0.0);
    return moved;
  }
};

TEST_F(WhatIfTest, OneThingAloneMakesItRight) {
  ExpectIous(truth_.landmark_in_world, 1.0, {1.0, 1.0, 1.0, 1.0});
  ExpectIous(MovedAlongX(0.2), 0.6, {0.6, 0.6, 1.0, 0.6});
  Landmark large = truth_.landmark_in_world;
  large.half_axes.x() *= 2.0;
  ExpectIous(large, 0.5, {0.5, 0.5, 0.5, 1.0});
  const double turned = Errors(Standing(1.0, 2.0, 50.0, {0.4, 0.2, 0.3})).iou;
  ExpectIous(Standing(1.0, 2.0, 50.0, {0.4, 0.2, 0.3}), turned, {1.0, turned, turned, turned});
}

// A body that is turned by more than half a quarter is one of another size as well.
TEST_F(WhatIfTest, AQuarterTurnIsOneOfYawOrSize) {
  ExpectIous(Standing(1.0, 2.0, 110.0, {0.4, 0.2, 0.3}), 1.0 / 3.0, {1.0, 1.0, 1.0 / 3.0, 1.0});
  ExpectIous(Standing(1.0, 2.0, 110.0, {0.2, 0.4, 0.3}), 1.0, {1.0, 1.0, 1.0, 1.0});
  const double by_20 = Errors(Standing(1.0, 2.0, 40.0, {0.4, 0.2, 0.3})).iou;
  const Landmark by_70 = Standing(1.0, 2.0, 90.0, {0.4, 0.2, 0.3});
  const double by_70_iou = Errors(by_70).iou;
  ExpectIous(by_70, by_70_iou, {1.0, by_20, by_70_iou, by_20});
}

// To turn the estimate, and the true box with it, would change the IoU, as the centre is wrong.
TEST_F(WhatIfTest, NothingTurnsARoundObject) {
  truth_.landmark_in_world = Standing(1.0, 2.0, 20.0, {0.2, 0.2, 0.3});
  truth_.rotationally_symmetric = true;
  const LandmarkErrors errors = Errors(Standing(1.1, 2.0, 65.0, {0.4, 0.2, 0.3}));
  EXPECT_EQ(errors.what_if->yaw, errors.iou);
  EXPECT_EQ(errors.what_if->quarter_turn, errors.iou);
  EXPECT_NEAR(errors.what_if->place, 0.5, 1e-9);
}

TEST_F(WhatIfTest, NamesOfAxesDoNotMatter) {
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d half_axes = RandomVector(0.1, 0.5);
    const double x = RandomUniform(0.8, 1.2), yaw_deg = RandomUniform(-25.0, 65.0);
    const LandmarkErrors one = Errors(Standing(x, 2.1, yaw_deg, half_axes));
    const LandmarkErrors renamed =
        Errors(Standing(x, 2.1, yaw_deg + 90.0, {half_axes.y(), half_axes.x(), half_axes.z()}));
    EXPECT_NEAR(one.iou, renamed.iou, 1e-9);
    EXPECT_NEAR(one.what_if->quarter_turn, renamed.what_if->quarter_turn, 1e-9);
    EXPECT_NEAR(one.what_if->place, renamed.what_if->place, 1e-9);
    EXPECT_NEAR(one.what_if->size, renamed.what_if->size, 1e-9);
    EXPECT_LE(one.what_if->yaw, renamed.what_if->yaw + 1e-9);
  }
}

TEST(RotationError, HidesTheRotationsOfTheCube) {
  const Eigen::Quaterniond truth = RandomRotation();
  for (int x = 0; x < 4; ++x) {
    for (int y = 0; y < 4; ++y) {
      for (int z = 0; z < 4; ++z) {
        const Eigen::Quaterniond turned = truth * ExpRotation({x * kPi / 2, 0, 0}) *
                                          ExpRotation({0, y * kPi / 2, 0}) *
                                          ExpRotation({0, 0, z * kPi / 2});
        EXPECT_NEAR(RotationError(turned, truth), 0.0, 1e-7);
      }
    }
  }
}

TEST(RotationError, IsTheAngleOfASmallTurn) {
  for (int i = 0; i < 100; ++i) {
    const Eigen::Quaterniond truth = RandomRotation();
    const double angle = RandomUniform(0.0, kPi / 4);
    const Eigen::Vector3d axis = RandomRotation() * Eigen::Vector3d::UnitX();
    const double error = RotationError(ExpRotation(angle * axis) * truth, truth);
    EXPECT_LE(error, angle + 1e-9);
    if (angle < kPi / 4 - 0.05) {
      EXPECT_NEAR(error, angle, 1e-9);
    }
  }
}

TEST(YawError, IsModuloHalfATurnButNotAQuarter) {
  const Eigen::Quaterniond truth = RandomRotation();
  const auto turned = [&](double yaw) {
    return Eigen::Quaterniond(truth * ExpRotation({0, 0, yaw}));
  };
  EXPECT_NEAR(YawError(turned(0.3), truth), 0.3, 1e-9);
  EXPECT_NEAR(YawError(turned(kPi + 0.3), truth), 0.3, 1e-9);
  EXPECT_NEAR(YawError(turned(-0.3), truth), 0.3, 1e-9);
  EXPECT_NEAR(YawError(turned(kPi / 2), truth), kPi / 2, 1e-9);
}

TEST(AttitudeError, DetectsQuarterTurnsAndOtherFacesButNoHalfTurns) {
  const Landmark truth{RandomRigid(), RandomVector(0.1, 1.0)};
  for (int axis = 0; axis < 3; ++axis) {
    for (const double turn : {0.2, kPi / 2, kPi, kPi + 0.2}) {
      Landmark turned = truth;
      turned.frame_from_object.rotation =
          truth.frame_from_object.rotation * Eigen::AngleAxisd(turn, Eigen::Vector3d::Unit(axis));
      const double expected = std::abs(std::remainder(turn, kPi));
      EXPECT_NEAR(AttitudeError(turned, truth), expected, 1e-7) << axis << ' ' << turn;
    }
  }
  // The same body in the frame of another face has the same attitude.
  for (const RestingFace face : kRestingFaces) {
    Landmark laid{truth.frame_from_object, HalfAxesOnFace(truth.half_axes, face)};
    laid.frame_from_object.rotation =
        truth.frame_from_object.rotation * Eigen::Quaterniond(OwnFromObject(face));
    laid.rests_on = face;
    EXPECT_NEAR(AttitudeError(laid, truth), 0.0, 1e-7);
  }
}

TEST(YawError, OfAnEstimateLyingOnItsFrontIsAQuarterTurn) {
  EXPECT_NEAR(YawError(ExpRotation({0, kPi / 2, 0}), Eigen::Quaterniond::Identity()), kPi / 2,
              1e-9);
}

}  // namespace
}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "soslam/geometry/iou.h"
#include "soslam/geometry/wireframe.h"
#include "soslam/orientation/cuboids.h"
#include "support/random.h"
#include "support/shape_exponents.h"
#include "support/upright_bodies.h"

namespace soslam {
namespace {

constexpr double kTolerancePx = 1e-6;

// A cuboid and its exact view.
struct TrueCuboid {
  TrueCuboid(const Plane& plane, const Landmark& cuboid)
      : landmark(cuboid), view{TestCamera(), BoxAroundCorners(cuboid), plane} {}

  double Yaw() const {
    return soslam::Yaw(view.plane_in_camera.normal, landmark.frame_from_object.rotation);
  }
  // The image column of the top corner farthest along the view, from the pixels: the top is level,
  // so its farthest corner is seen at the smallest angle to the horizon, from the side.
  double FarthestColumn() const {
    const Eigen::Vector3d& up = view.plane_in_camera.normal;
    const Eigen::Vector3d side = up.cross(TestCamera().Ray(view.box.Centre())).normalized();
    double smallest = std::numeric_limits<double>::infinity(), column = 0.0;
    for (const Eigen::Vector3d& corner : CornersOf(landmark)) {
      if (up.dot(corner - landmark.Centre()) < 0.0) continue;
      const Eigen::Vector2d pixel = *TestCamera().Project(corner);
      const Eigen::Vector3d ray = TestCamera().Ray(pixel);
      const double angle = std::atan2(std::abs(up.dot(ray)), side.cross(up).dot(ray));
      if (angle >= smallest) continue;
      smallest = angle;
      column = pixel.x();
    }
    return column;
  }

  Landmark landmark;
  CuboidView view;
};

TrueCuboid RandomTrueCuboid() {
  const Plane floor = RandomFloor();
  return {floor, RandomUprightBody(floor, kCuboidExponent)};
}

void ExpectSameCuboid(const Landmark& found, const Landmark& truth) {
  const double size = truth.half_axes.maxCoeff();
  EXPECT_LT((found.Centre() - truth.Centre()).norm(), 1e-6 * size);
  EXPECT_LT((found.half_axes - truth.half_axes).norm(), 1e-6 * size);
  EXPECT_LT(found.frame_from_object.rotation.angularDistance(truth.frame_from_object.rotation),
            1e-6);
  EXPECT_EQ(found.shape_exponents, kCuboidExponent);
  const auto found_corners = CornersOf(found), true_corners = CornersOf(truth);
  for (size_t i = 0; i < true_corners.size(); ++i) {
    EXPECT_LT(
        (*TestCamera().Project(found_corners[i]) - *TestCamera().Project(true_corners[i])).norm(),
        kTolerancePx);
  }
}

// A camera turned about its optical axis by any angle, also upside down: objects that hang.
TEST(CuboidAt, IsTheTrueCuboidForACameraInAnyAttitude) {
  for (int i = 0; i < 300; ++i) {
    const TrueCuboid upright = RandomTrueCuboid();
    const Rigid3d roll = {Eigen::Quaterniond(Eigen::AngleAxisd(
                              RandomUniform(-3.1, 3.1), upright.landmark.Centre().normalized())),
                          Eigen::Vector3d::Zero()};
    const TrueCuboid truth(Transform(roll, upright.view.plane_in_camera),
                           Transform(roll, upright.landmark));
    const double column = truth.FarthestColumn();
    const auto found = CuboidAt(truth.view, truth.Yaw(), column);
    const double to_side = std::min(column - truth.view.box.x_min, truth.view.box.x_max - column);
    // A corner that touches the left or right edge of the box leaves a degree of freedom.
    EXPECT_EQ(found.has_value(), to_side > kTolerancePx) << i << " " << to_side;
    if (found) ExpectSameCuboid(*found, truth.landmark);
  }
}

// Two top corners are equally far: rounding does not decide whose column is given.
TEST(CuboidAt, HasTheCornerOnTheLeftAtTheYawThatFacesTheCamera) {
  int found_count = 0;
  for (int i = 0; i < 50; ++i) {
    const CuboidView view = RandomTrueCuboid().view;
    const double column = view.box.x_min + 0.3 * view.box.Width();
    for (const double rounding : {-1e-12, 0.0, 1e-12}) {
      const auto cuboid = CuboidAt(view, YawFacingCamera(view) + rounding, column);
      if (!cuboid) continue;
      ++found_count;
      const double left = TestCamera().Project(PointAt(*cuboid, {-1, -1, 1}))->x();
      const double right = TestCamera().Project(PointAt(*cuboid, {-1, 1, 1}))->x();
      EXPECT_NEAR(left, column, kTolerancePx) << i << " " << rounding;
      EXPECT_LT(left, right);
    }
  }
  EXPECT_GT(found_count, 50);
}

// Planes of any attitude: walls, ceilings, floors that are not in view.
TEST(ProposeCuboids, FillTheBoxOnAnyPlaneOrAreNone) {
  int proposed = 0;
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector2d corner(RandomUniform(0, 500), RandomUniform(0, 400));
    const Box box = {corner.x(), corner.y(), corner.x() + RandomUniform(5, 140),
                     corner.y() + RandomUniform(5, 80)};
    for (const CuboidProposal& proposal :
         ProposeCuboids({TestCamera(), box, RandomPlane()}, 3, 3)) {
      ++proposed;
      EXPECT_TRUE(HasExtent(proposal.landmark_in_camera));
      ASSERT_TRUE(IsInFront(proposal.landmark_in_camera));
      const Box around = BoxAroundCorners(proposal.landmark_in_camera);
      EXPECT_GT(BoxOverlap(around, box), 1.0 - 1e-6);
    }
  }
  EXPECT_GT(proposed, 100);
}

TEST(ProposeCuboids, HaveOneNearTheTruthWhereSamplesAreDense) {
  for (int i = 0; i < 10; ++i) {
    const TrueCuboid truth = RandomTrueCuboid();
    double best = 0.0;
    for (const CuboidProposal& proposal : ProposeCuboids(truth.view, 90, 60)) {
      best = std::max(best, BoxIou(proposal.landmark_in_camera, truth.landmark));
    }
    EXPECT_GT(best, 0.8) << i;
  }
}

TEST(ProposeCuboids, SurviveBoxesAndPlanesThatCannotBe) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Plane floor = {-Eigen::Vector3d::UnitY(), 1.0};
  for (const CuboidView& view :
       {CuboidView{TestCamera(), {300, 300, 300, 300}, floor},
        {TestCamera(), {300, 300, 300.001, 400}, floor},
        {TestCamera(), {nan, 300, 400, 400}, floor},
        {TestCamera(), {300, 300, 400, 400}, {-Eigen::Vector3d::UnitY(), 0.0}},
        {TestCamera(), {300, 300, 400, 400}, {Eigen::Vector3d::UnitZ(), -2.0}},
        {TestCamera(), {300, 300, 400, 400}, {-Eigen::Vector3d::UnitZ(), 2.0}},
        {TestCamera(), {300, 300, 400, 400}, {-Eigen::Vector3d::UnitY(), nan}}}) {
    for (const CuboidProposal& proposal : ProposeCuboids(view, 15, 10)) {
      EXPECT_TRUE(HasExtent(proposal.landmark_in_camera));
      EXPECT_TRUE(IsInFront(proposal.landmark_in_camera));
    }
  }
}

}  // namespace
}  // namespace soslam

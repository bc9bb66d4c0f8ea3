// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/geometry/rigid3.h"

#include <gtest/gtest.h>

#include "soslam/geometry/angles.h"
#include "soslam/geometry/box.h"
#include "soslam/geometry/plane.h"
#include "soslam/geometry/triangulation.h"
#include "support/random.h"

namespace soslam {
namespace {

TEST(Rigid3, ComposesAndInvertsLikeItsMatrix) {
  for (int i = 0; i < 100; ++i) {
    const Rigid3d one = RandomRigid();
    const Rigid3d other = RandomRigid();
    EXPECT_TRUE((one * other).Matrix().isApprox(one.Matrix() * other.Matrix(), 1e-12));
    EXPECT_TRUE(one.Inverse().Matrix().isApprox(one.Matrix().inverse(), 1e-9));
  }
}

TEST(Rotation, LogIsTheInverseOfExp) {
  for (const double angle : {0.0, 1e-12, 1e-6, 1e-3, 1.0, 3.0, 3.14159}) {
    const Eigen::Vector3d vector = angle * (RandomRotation() * Eigen::Vector3d::UnitX());
    const Eigen::Quaterniond rotation = ExpRotation(vector);
    EXPECT_LT((LogRotation(rotation) - vector).norm(), 1e-9) << angle;
    const Eigen::Quaterniond negated(-rotation.coeffs());
    EXPECT_LT((LogRotation(negated) - vector).norm(), 1e-9) << angle;
  }
}

TEST(Rotation, BetweenDirectionsTurnsOneIntoTheOtherByTheAngleBetween) {
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d from = RandomRotation() * Eigen::Vector3d::UnitX();
    const Eigen::Vector3d to =
        i == 0 ? Eigen::Vector3d(-from) : RandomRotation() * Eigen::Vector3d::UnitX();
    const Eigen::Quaterniond rotation = RotationBetween(from, to);
    EXPECT_LT((rotation * from - to).norm(), 1e-9);
    EXPECT_NEAR(LogRotation(rotation).norm(), AngleBetween(from, to), 1e-6);
  }
}

TEST(PointOnPlanes, IsThePointThatAllPlanesShare) {
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d point = RandomRigid().translation;
    PointOnPlanes on_planes;
    for (int plane = 0; plane < 4; ++plane) {
      const Eigen::Vector3d normal = RandomRotation() * Eigen::Vector3d::UnitX();
      on_planes.Add({normal, -normal.dot(point)}, RandomUniform(0.1, 2.0));
    }
    EXPECT_LT((on_planes.Solve() - point).norm(), 1e-6);
  }
}

TEST(PointOnPlanes, IsNearestToTheOriginOfThoseOnOnePlane) {
  const Plane plane = {Eigen::Vector3d(1.0, 2.0, 2.0) / 3.0, -6.0};
  PointOnPlanes on_planes;
  on_planes.Add(plane);
  EXPECT_LT((on_planes.Solve() - 6.0 * plane.normal).norm(), 1e-12);
}

TEST(Camera, RayAndBackProjectedPlanesUndoProjection) {
  const Camera camera = TestCamera();
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d point(RandomUniform(-2, 2), RandomUniform(-2, 2), RandomUniform(0.1, 9));
    const auto pixel = camera.Project(point);
    ASSERT_TRUE(pixel);
    EXPECT_LT((point.z() * camera.Ray(*pixel) - point).norm(), 1e-12);
    EXPECT_NEAR(camera.BackProject({1, 0, -pixel->x()}).SignedDistance(point), 0.0, 1e-12);
    EXPECT_NEAR(camera.BackProject({0, 1, -pixel->y()}).SignedDistance(point), 0.0, 1e-12);
  }
  EXPECT_FALSE(camera.Project({0, 0, 0}));
  EXPECT_FALSE(camera.Project({1, 1, -1}));
}

TEST(Box, OverlapIsIntersectionOverUnion) {
  constexpr Box kBox{0, 0, 10, 10};
  EXPECT_EQ(BoxOverlap(kBox, kBox), 1.0);
  EXPECT_DOUBLE_EQ(BoxOverlap(kBox, {5, 0, 15, 10}), 50.0 / 150.0);
  EXPECT_DOUBLE_EQ(BoxOverlap(kBox, {2, 2, 4, 4}), 0.04);
  EXPECT_EQ(BoxOverlap(kBox, {10, 0, 20, 10}), 0.0);
  EXPECT_EQ(BoxOverlap(kBox, {3, 3, 3, 3}), 0.0);
}

TEST(Box, DistanceToBorderCountsFromThePixelEdges) {
  EXPECT_EQ(DistanceToBorder({29.5, 100, 300, 300}, 640, 480), 30.0);
  EXPECT_EQ(DistanceToBorder({100, 100, 609.5, 300}, 640, 480), 30.0);
  EXPECT_EQ(DistanceToBorder({100, 100, 300, 479.5}, 640, 480), 0.0);
  EXPECT_EQ(DistanceToBorder({100, -3.5, 300, 300}, 640, 480), -3.0);
}

}  // namespace
}  // namespace soslam

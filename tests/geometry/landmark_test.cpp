// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/landmark.h"

#include <gtest/gtest.h>

#include "support/random.h"

namespace soslam {
namespace {

Eigen::Vector3d RandomSurfacePoint(const Landmark& landmark) {
  const Eigen::Vector3d on_sphere = RandomRotation() * Eigen::Vector3d::UnitX();
  return landmark.frame_from_object * landmark.half_axes.cwiseProduct(on_sphere);
}

TEST(Landmark, QuadricIsZeroOnTheSurfaceAndInverseOfTheDualQuadric) {
  for (int i = 0; i < 100; ++i) {
    const Landmark landmark{RandomRigid(), RandomVector(0.1, 2.0)};
    const Eigen::Matrix4d quadric = Quadric(landmark);
    const Eigen::Vector4d point = RandomSurfacePoint(landmark).homogeneous();
    EXPECT_NEAR(point.dot(quadric * point), 0.0, 1e-9);
    EXPECT_TRUE((quadric * DualQuadric(landmark)).isApprox(Eigen::Matrix4d::Identity(), 1e-6));
  }
}

TEST(Landmark, TangentPlanesSatisfyTheDualQuadric) {
  for (int i = 0; i < 100; ++i) {
    const Landmark landmark{RandomRigid(), RandomVector(0.1, 2.0)};
    const Eigen::Vector4d point = RandomSurfacePoint(landmark).homogeneous();
    Eigen::Vector4d tangent = Quadric(landmark) * point;
    tangent /= tangent.head<3>().norm();
    EXPECT_NEAR(tangent.dot(DualQuadric(landmark) * tangent), 0.0, 1e-9);
  }
}

TEST(Landmark, ComesBackFromItsDualQuadric) {
  for (int i = 0; i < 100; ++i) {
    const Landmark landmark{RandomRigid(), RandomVector(0.1, 2.0)};
    const auto found = LandmarkFromDualQuadric(RandomUniform(-5, 5) * DualQuadric(landmark));
    ASSERT_TRUE(found);
    EXPECT_TRUE(found->proper);
    EXPECT_TRUE(DualQuadric(found->landmark).isApprox(DualQuadric(landmark), 1e-9));
  }
}

TEST(Landmark, AHyperboloidIsNotProper) {
  Eigen::Matrix4d dual_quadric = DualQuadric(Landmark{RandomRigid(), {1, 1, 1}});
  dual_quadric.topLeftCorner<3, 3>() -= 2.0 * Eigen::Vector3d::UnitX().asDiagonal().toDenseMatrix();
  const auto found = LandmarkFromDualQuadric(dual_quadric);
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->proper);
  EXPECT_FALSE(LandmarkFromDualQuadric(Eigen::Matrix4d::Zero()));
  EXPECT_FALSE(
      LandmarkFromDualQuadric(Eigen::Matrix4d::Constant(std::numeric_limits<double>::quiet_NaN())));
}

TEST(OutlineBox, IsTheTightBoxOfTheProjectedSurface) {
  for (int i = 0; i < 20; ++i) {
    const Landmark landmark = RandomLandmarkInCamera();
    const auto box = OutlineBox(TestCamera(), landmark);
    ASSERT_TRUE(box);
    Box sampled{1e9, 1e9, -1e9, -1e9};
    for (int k = 0; k < 40000; ++k) {
      const auto pixel = TestCamera().Project(RandomSurfacePoint(landmark));
      ASSERT_TRUE(pixel);
      EXPECT_TRUE(box->Contains(*pixel));
      sampled = {std::min(sampled.x_min, pixel->x()), std::min(sampled.y_min, pixel->y()),
                 std::max(sampled.x_max, pixel->x()), std::max(sampled.y_max, pixel->y())};
    }
    // Samples come within about 1/40000 of the extent of each tangent point.
    EXPECT_NEAR(sampled.x_min, box->x_min, 0.5);
    EXPECT_NEAR(sampled.y_min, box->y_min, 0.5);
    EXPECT_NEAR(sampled.x_max, box->x_max, 0.5);
    EXPECT_NEAR(sampled.y_max, box->y_max, 0.5);
  }
}

TEST(OutlineBox, NeedsTheWholeLandmarkInFront) {
  Landmark landmark{Rigid3d(), {0.5, 0.5, 0.5}};
  for (const double depth : {-2.0, 0.0, 0.4, 0.5}) {
    landmark.frame_from_object.translation.z() = depth;
    EXPECT_FALSE(OutlineBox(TestCamera(), landmark)) << depth;
  }
  landmark.frame_from_object.translation.z() = 0.51;
  EXPECT_TRUE(OutlineBox(TestCamera(), landmark));
}

TEST(NearestIntersection, IsOnTheSurfaceAndNearest) {
  for (int i = 0; i < 200; ++i) {
    const Landmark landmark = RandomLandmarkInCamera();
    const Eigen::Vector3d target = RandomSurfacePoint(landmark);
    const auto depth = NearestIntersection(landmark, Eigen::Vector3d::Zero(), target);
    ASSERT_TRUE(depth);
    const Eigen::Vector4d point = (*depth * target).homogeneous();
    EXPECT_NEAR(point.dot(Quadric(landmark) * point), 0.0, 1e-9);
    EXPECT_LE(*depth, 1.0 + 1e-9);  // the target itself, or a point before it
  }
}

TEST(NearestIntersection, MissesBehindInsideAndBeside) {
  const Landmark landmark{{Eigen::Quaterniond::Identity(), {0, 0, 3}}, {1, 1, 1}};
  const Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  EXPECT_NEAR(*NearestIntersection(landmark, origin, {0, 0, 1}), 2.0, 1e-12);
  EXPECT_FALSE(NearestIntersection(landmark, origin, {0, 0, -1}));
  EXPECT_FALSE(NearestIntersection(landmark, {0, 0, 3.5}, {0, 0, 1}));
  EXPECT_FALSE(NearestIntersection(landmark, origin, {0, 0.5, 1}));
}

TEST(Mirror, IsAnIsometryThatFixesTheXzPlaneAndUndoesItself) {
  for (int i = 0; i < 100; ++i) {
    const Landmark landmark{RandomRigid(), RandomVector(0.1, 2.0)};
    const Eigen::Vector3d point = RandomVector(-3, 3);
    const Eigen::Vector3d mirrored = Mirror(landmark, point);
    EXPECT_LT((Mirror(landmark, mirrored) - point).norm(), 1e-12);
    EXPECT_NEAR((mirrored - landmark.Centre()).norm(), (point - landmark.Centre()).norm(), 1e-12);
    const Eigen::Vector3d in_plane =
        landmark.frame_from_object * Eigen::Vector3d(RandomUniform(-1, 1), 0, RandomUniform(-1, 1));
    EXPECT_LT((Mirror(landmark, in_plane) - in_plane).norm(), 1e-12);
    // Equivariance: mirroring and moving the world commute.
    const Rigid3d motion = RandomRigid();
    EXPECT_LT((Mirror(Transform(motion, landmark), motion * point) - motion * mirrored).norm(),
              1e-9);
  }
}

TEST(Yaw, IsTheInverseOfUprightRotationAndTurned) {
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d normal = RandomRotation() * Eigen::Vector3d::UnitZ();
    const double yaw = RandomUniform(-3.1, 3.1);
    const Eigen::Quaterniond rotation = UprightRotation(normal, yaw);
    EXPECT_NEAR(Yaw(normal, rotation), yaw, 1e-9);
    EXPECT_LT((rotation * Eigen::Vector3d::UnitZ() - normal).norm(), 1e-12);
    const double turn = RandomUniform(-1.5, 1.5);
    const Landmark turned = Turned({{rotation, {}}, {1, 2, 3}}, turn);
    EXPECT_NEAR(YawDifferenceModuloPi(Yaw(normal, turned.frame_from_object.rotation), yaw), turn,
                1e-9);
  }
}

TEST(YawDifferenceModuloPi, WrapsAtQuarterTurns) {
  constexpr double kPi = std::numbers::pi;
  EXPECT_NEAR(YawDifferenceModuloPi(kPi, 0.0), 0.0, 1e-12);
  EXPECT_NEAR(YawDifferenceModuloPi(0.6 * kPi, 0.0), -0.4 * kPi, 1e-12);
  EXPECT_NEAR(YawDifferenceModuloPi(-0.6 * kPi, 0.0), 0.4 * kPi, 1e-12);
  EXPECT_NEAR(YawDifferenceModuloPi(0.1, 7.0 * kPi), 0.1, 1e-12);
}

}  // namespace
}  // namespace soslam

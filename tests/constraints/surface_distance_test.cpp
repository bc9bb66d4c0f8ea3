// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/constraints/surface_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "soslam/geometry/surface.h"
#include "support/landmark_costs.h"
#include "support/random.h"

namespace soslam {
namespace {

Landmark RandomBody(const ShapeExponents& shape_exponents) {
  return {RandomRigid(), RandomVector(0.2, 1.0), shape_exponents};
}

TEST(SurfaceDistanceTest, OfACuboidIsThatOfTheNearestFaceInside) {
  for (int i = 0; i < 100; ++i) {
    const Landmark cuboid = RandomBody(kCuboidExponent);
    const Eigen::Vector3d in_object = cuboid.half_axes.cwiseProduct(RandomVector(-1.0, 1.0));
    EXPECT_NEAR(SurfaceDistance(cuboid, cuboid.frame_from_object * in_object, nullptr),
                -(cuboid.half_axes - in_object.cwiseAbs()).minCoeff(), 1e-12);
  }
}

TEST(SurfaceDistanceTest, OfACuboidIsThatOfAFace) {
  const Landmark cuboid{{}, {1.0, 2.0, 3.0}, kCuboidExponent};
  Eigen::Vector3d normal;
  EXPECT_NEAR(SurfaceDistance(cuboid, {1.25, 0.5, -1.0}, nullptr, &normal), 0.25, 1e-12);
  EXPECT_LT((normal - Eigen::Vector3d::UnitX()).norm(), 1e-12);
  EXPECT_NEAR(SurfaceDistance(cuboid, {0.2, -1.5, 0.3}, nullptr, &normal), -0.5, 1e-12);
  EXPECT_LT((normal + Eigen::Vector3d::UnitY()).norm(), 1e-12);
}

TEST(SurfaceDistanceTest, OfASphereIsExact) {
  const Landmark sphere{{}, {2.0, 2.0, 2.0}, kEllipsoidExponent};
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d point = RandomVector(-4.0, 4.0);
    EXPECT_NEAR(SurfaceDistance(sphere, point, nullptr), point.norm() - 2.0, 1e-9);
  }
}

TEST(SurfaceDistanceTest, OfARoundCylinderIsThatOfItsSideOrItsCap) {
  const Landmark cylinder{{}, {0.5, 0.5, 1.0}, {kEllipsoidExponent, kCuboidExponent}};
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d point = RandomVector(-1.5, 1.5);
    EXPECT_NEAR(SurfaceDistance(cylinder, point, nullptr),
                std::max(point.head<2>().norm() - 0.5, std::abs(point.z()) - 1.0), 1e-12);
  }
}

// Points at a small distance from where a ray meets the surface.
TEST(SurfaceDistanceTest, IsTheDistanceNearTheSurface) {
  constexpr double kStepM = 1e-4;
  for (int i = 0; i < 100; ++i) {
    const Landmark body = RandomBody({RandomUniform(1.2, 2.0), RandomUniform(1.2, 2.0)});
    const BodySurface surface(body.half_axes, body.shape_exponents);
    const Eigen::Vector3d origin = 5.0 * RandomVector(-1.0, 1.0).normalized();
    const auto depth = surface.Entry(origin, -origin);
    ASSERT_TRUE(depth);
    const Eigen::Vector3d in_object = (1.0 - *depth) * origin;
    const Eigen::Vector3d outwards = surface.Gradient(in_object).normalized();
    for (const double step : {-kStepM, 0.0, kStepM}) {
      Eigen::Vector3d normal;
      const double distance = SurfaceDistance(
          body, body.frame_from_object * (in_object + step * outwards), nullptr, &normal);
      EXPECT_NEAR(distance, step, 1e-2 * kStepM);
      EXPECT_LT((normal - body.frame_from_object.rotation * outwards).norm(), 1e-2);
    }
  }
}

TEST(SurfaceDistanceTest, JacobiansAgreeWithNumbers) {
  for (int i = 0; i < 100; ++i) {
    ShapeExponents p(RandomUniform(1.1, 2.0), RandomUniform(1.1, 2.0));
    if (i % 4 == 0) p.vertical = kCuboidExponent;
    if (i % 8 < 2) p.horizontal = kCuboidExponent;
    const Landmark body = RandomBody(p);
    const Eigen::Vector3d point = body.Centre() + RandomVector(-1.0, 1.0);
    LandmarkJacobian1 jacobian;
    SurfaceDistance(body, point, &jacobian);
    ExpectDerivative(jacobian, body,
                     [&](const Landmark& moved) { return SurfaceDistance(moved, point, nullptr); });
  }
}

TEST(SurfaceDistanceTest, AtTheCentreIsTheShortestHalfAxis) {
  Landmark body = RandomBody(1.5);
  body.half_axes = {0.5, 0.3, 0.7};
  LandmarkJacobian1 jacobian;
  EXPECT_EQ(SurfaceDistance(body, body.Centre(), &jacobian), -0.3);
  EXPECT_TRUE(jacobian.isZero());
}

}  // namespace
}  // namespace soslam

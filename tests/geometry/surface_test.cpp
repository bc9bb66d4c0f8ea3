// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/geometry/surface.h"

#include <gtest/gtest.h>

#include "support/shape_exponents.h"

namespace soslam {
namespace {

// A ray from outside towards a point well inside the body.
struct RandomRay {
  Eigen::Vector3d half_axes = RandomVector(0.2, 1.0);
  Eigen::Vector3d origin = RandomUniform(2.0, 4.0) * RandomDirection();
  Eigen::Vector3d direction =
      RandomUniform(0.2, 2.0) * (half_axes.cwiseProduct(RandomVector(-0.4, 0.4)) - origin);
};

TEST(BodySurface, EntryIsTheFirstPointOfTheBody) {
  for (const ShapeExponents& p : kShapeExponents) {
    for (int i = 0; i < 200; ++i) {
      const RandomRay ray;
      const auto depth = BodySurface(ray.half_axes, p).Entry(ray.origin, ray.direction);
      ASSERT_TRUE(depth) << p;
      EXPECT_GT(*depth, 0.0);
      const auto norm_at = [&](double at) {
        return SurfaceNorm(ray.half_axes, p, ray.origin + at * ray.direction);
      };
      EXPECT_NEAR(norm_at(*depth), 1.0, 1e-9) << p;
      for (int k = 0; k < 20; ++k) EXPECT_GT(norm_at(*depth * 0.05 * k), 1.0);
    }
  }
}

TEST(BodySurface, GradientIsTheOutwardNormal) {
  for (const ShapeExponents& p : kShapeExponents) {
    for (int i = 0; i < 200; ++i) {
      const RandomRay ray;
      const BodySurface surface(ray.half_axes, p);
      const Eigen::Vector3d point =
          ray.origin + *surface.Entry(ray.origin, ray.direction) * ray.direction;
      const Eigen::Vector3d gradient = surface.Gradient(point);
      EXPECT_NEAR(gradient.dot(point), 1.0, 1e-9) << p;
      EXPECT_LT(gradient.dot(ray.direction), 0.0);
      // The body reaches no farther than the tangent plane, gradient . x = 1.
      const SupportValue support = SupportFunction(ray.half_axes, p, gradient);
      EXPECT_NEAR(support.extent, 1.0, kEdgeRounding * gradient.norm() * ray.half_axes.sum()) << p;
    }
  }
}

TEST(BodySurface, MissesBesideBehindAndFromInside) {
  const Eigen::Vector3d half_axes(1.0, 1.0, 1.0);
  for (const ShapeExponents& p : kShapeExponents) {
    const BodySurface surface(half_axes, p);
    EXPECT_NEAR(*surface.Entry({0, 0, -3}, {0, 0, 2}), 1.0, 1e-12) << p;
    EXPECT_FALSE(surface.Entry({0, 0, -3}, {0, 0, -1})) << p;
    EXPECT_FALSE(surface.Entry({0, 0, -3}, {0, 1, 1})) << p;
    EXPECT_FALSE(surface.Entry({0, 2, -3}, {0, 0, 1})) << p;
    EXPECT_FALSE(surface.Entry({0.1, 0.2, 0.3}, {0, 0, 1})) << p;
    // Past a corner of the cuboid around it, which only the cuboid fills.
    EXPECT_EQ(surface.Entry({0.99, 3, -1.04}, {0, -1, 1}).has_value(), p == kCuboidExponent) << p;
  }
}

TEST(BodySurface, IsSeenFromInsideTheCuboidAroundIt) {
  for (const double p : {1.02, 1.1, 1.5, 2.0}) {
    const BodySurface surface({0.5, 0.6, 0.7}, p);
    const Eigen::Vector3d origin(0.499, 0.599, 0.699);
    const auto depth = surface.Entry(origin, -origin);
    ASSERT_TRUE(depth) << p;
    EXPECT_NEAR(SurfaceNorm({0.5, 0.6, 0.7}, p, (1.0 - *depth) * origin), 1.0, 1e-9) << p;
    EXPECT_FALSE(surface.Entry(origin, origin)) << p;
  }
}

}  // namespace
}  // namespace soslam

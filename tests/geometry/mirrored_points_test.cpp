// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/mirrored_points.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/mirror_mapping.h"
#include "support/random.h"

namespace soslam {
namespace {

std::vector<Eigen::Vector2d> PixelsAroundTheMiddle(int count) {
  std::vector<Eigen::Vector2d> pixels;
  for (int i = 0; i < count; ++i) {
    pixels.emplace_back(RandomUniform(150, 490), RandomUniform(100, 380));
  }
  return pixels;
}

// Points are the same up to rounding to single precision (6e-8 of a number), on ellipsoids up to
// that of some 20 operations in it. Which ones are visible is the same but for pixels that miss the
// limit by as little; there are none among these.
TEST(MirroredPoints, AreThoseOfEachPixel) {
  constexpr double kMinCosine = 0.3;
  const Camera camera = TestCamera();
  const std::vector<Eigen::Vector2d> pixels = PixelsAroundTheMiddle(500);  // no whole batches
  const PixelRays rays(camera, pixels);
  MirroredPoints points;
  size_t found = 0;
  for (const double shape_exponent : {kCuboidExponent, 1.1, 1.5, kEllipsoidExponent}) {
    for (int i = 0; i < 10; ++i) {
      Landmark landmark = RandomLandmarkInCamera();
      landmark.shape_exponent = shape_exponent;
      points.Find(landmark, rays, kMinCosine);
      const VisibleSurface surface(camera, landmark);
      const double tolerance = shape_exponent == kEllipsoidExponent ? 5e-6 : 1e-7;
      size_t on_surface = 0;
      size_t next = 0;
      for (size_t k = 0; k < pixels.size(); ++k) {
        const auto point = surface.FromPixel(pixels[k]);
        if (!point) continue;
        ++on_surface;
        const VisibleSurface::Point mirrored = surface.MirrorImage(*point);
        if (!(surface.ViewingCosine(*point) >= kMinCosine) ||
            !(surface.ViewingCosine(mirrored) >= kMinCosine)) {
          continue;
        }
        ASSERT_LT(next, points.ray.size());
        EXPECT_EQ(points.ray[next], k);
        const Eigen::Vector3d in_camera = landmark.frame_from_object * mirrored.in_object;
        const Eigen::Vector3d in_image = camera.Intrinsics() * in_camera;
        for (size_t axis = 0; axis < 3; ++axis) {
          const double expected = in_image[static_cast<Eigen::Index>(axis)];
          EXPECT_NEAR(points.in_image[axis][next], expected, tolerance * std::abs(expected));
        }
        ++next;
      }
      EXPECT_EQ(points.on_surface, on_surface);
      EXPECT_EQ(points.ray.size(), next);
      found += next;
    }
  }
  EXPECT_GT(found, 500u);
}

TEST(MirroredPoints, WhatIsLeftOfTheLastBatchIsItsLastPoint) {
  const Landmark landmark{{Eigen::Quaterniond::Identity(), {0, 0, 3}}, {0.5, 0.5, 0.5}};
  MirroredPoints points;
  points.Find(landmark, PixelRays(TestCamera(), {{318, 242}, {320, 240}, {0, 0}}), 0.0);
  EXPECT_EQ(points.on_surface, 2u);
  ASSERT_EQ(points.NumBatches(), 1u);
  for (const auto& coordinate : points.in_image) {
    ASSERT_TRUE(std::isfinite(coordinate[1]));
    for (size_t i = 2; i < kBatchSize; ++i) EXPECT_EQ(coordinate[i], coordinate[1]);
  }
}

TEST(MirroredPoints, ThereAreNoneFromInsideTheBody) {
  MirroredPoints points;
  for (const double shape_exponent : {kCuboidExponent, 1.5, kEllipsoidExponent}) {
    const Landmark around{{Eigen::Quaterniond::Identity(), {0, 0, 0.1}}, {1, 1, 1}, shape_exponent};
    points.Find(around, PixelRays(TestCamera(), PixelsAroundTheMiddle(10)), 0.0);
    EXPECT_EQ(points.on_surface, 0u);
    EXPECT_EQ(points.NumBatches(), 0u);
  }
}

}  // namespace
}  // namespace soslam

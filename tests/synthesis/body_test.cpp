// SPDX-License-Identifier: BSD-3-Clause
#include "synthesis/body.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/random.h"

namespace soslam {
namespace {

// The solid that touches a plane from behind: max over its points of n . x, by shape, in the object
// frame. What the library derives from dual quadrics and corners, in another way.
double Support(Shape shape, const Eigen::Vector3d& half_axes, const Eigen::Vector3d& normal) {
  const Eigen::Vector3d scaled = half_axes.cwiseProduct(normal);
  if (shape == Shape::kBox) return scaled.lpNorm<1>();
  if (shape == Shape::kEllipsoid) return scaled.norm();
  return scaled.head<2>().norm() + std::abs(scaled.z());
}

// A point of the surface in the direction of longitude and latitude, by central projection.
Eigen::Vector3d SurfacePoint(Shape shape, const Eigen::Vector3d& half_axes, double longitude,
                             double latitude) {
  const Eigen::Vector3d direction(std::cos(latitude) * std::cos(longitude),
                                  std::cos(latitude) * std::sin(longitude), std::sin(latitude));
  double gauge = direction.norm();
  if (shape == Shape::kBox) gauge = direction.lpNorm<Eigen::Infinity>();
  if (shape == Shape::kCylinder) {
    gauge = std::max(direction.head<2>().norm(), std::abs(direction.z()));
  }
  return (direction / gauge).cwiseProduct(half_axes);
}

Box SampledOutline(const Camera& camera, Shape shape, const Landmark& body_in_camera) {
  constexpr int kSteps = 1000;
  Box box = {1e9, 1e9, -1e9, -1e9};
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j <= kSteps / 2; ++j) {
      const Eigen::Vector3d point =
          SurfacePoint(shape, body_in_camera.half_axes, 2.0 * std::numbers::pi * i / kSteps,
                       std::numbers::pi * (2.0 * j / kSteps - 0.5));
      const Eigen::Vector2d pixel =
          camera.Project(body_in_camera.frame_from_object * point).value();
      box = {std::min(box.x_min, pixel.x()), std::min(box.y_min, pixel.y()),
             std::max(box.x_max, pixel.x()), std::max(box.y_max, pixel.y())};
    }
  }
  return box;
}

class BodyTest : public testing::TestWithParam<Shape> {
 protected:
  // The landmark with the shape under test.
  static Landmark Shaped(Landmark landmark) {
    landmark.shape_exponents = ExponentsOf(GetParam());
    return landmark;
  }
};

INSTANTIATE_TEST_SUITE_P(Shapes, BodyTest,
                         testing::Values(Shape::kBox, Shape::kEllipsoid, Shape::kCylinder));

TEST_P(BodyTest, OutlineHoldsSampledSurfaceTightly) {
  const Camera camera = TestCamera();
  for (int trial = 0; trial < 5; ++trial) {
    const Landmark body = Shaped(RandomLandmarkInCamera());
    const Box sampled = SampledOutline(camera, GetParam(), body);
    const Box exact = ExactOutline(camera, body).value();
    // Samples are inside the body, so their box is inside the exact one; steps of 0.006 rad miss
    // the extreme point by less than half a pixel here (rims of cylinders and corners are hit less
    // well than smooth surfaces).
    const double slack_px = GetParam() == Shape::kEllipsoid ? 0.05 : 1.5;
    const auto outward = [](const Box& box) {
      return Eigen::Array4d(-box.x_min, -box.y_min, box.x_max, box.y_max);
    };
    const Eigen::Array4d missed = outward(exact) - outward(sampled);
    EXPECT_GE(missed.minCoeff(), -1e-9);
    EXPECT_LE(missed.maxCoeff(), slack_px);
  }
}

TEST_P(BodyTest, BackProjectedBoxEdgesAreTangent) {
  const Camera camera = TestCamera();
  for (int trial = 0; trial < 200; ++trial) {
    const Landmark body = Shaped(RandomLandmarkInCamera());
    const Rigid3d& camera_from_object = body.frame_from_object;
    for (const Eigen::Vector3d& line : ExactOutline(camera, body)->EdgeLines()) {
      const Plane plane_in_camera = camera.BackProject(line);
      const Eigen::Vector3d normal_in_object =
          camera_from_object.rotation.conjugate() * plane_in_camera.normal;
      const double extent = Support(GetParam(), body.half_axes, normal_in_object);
      // Rounding only: metres, at 2.5 to 5 metres.
      EXPECT_NEAR(std::abs(plane_in_camera.SignedDistance(body.Centre())), extent, 1e-12);
    }
  }
}

TEST_P(BodyTest, NoOutlineUnlessWhollyInFront) {
  const Landmark landmark = {{RandomRotation(), {0.0, 0.0, 0.2}}, {0.5, 0.4, 0.3}};
  EXPECT_FALSE(ExactOutline(TestCamera(), Shaped(landmark)));
  const Landmark behind = {{RandomRotation(), {0.0, 0.0, -5.0}}, {0.5, 0.4, 0.3}};
  EXPECT_FALSE(ExactOutline(TestCamera(), Shaped(behind)));
}

TEST_P(BodyTest, RayMeetsSurfaceFirstWhereItEnters) {
  int hits = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const Landmark body = Shaped(RandomLandmarkInCamera());
    const Eigen::Vector3d direction =
        body.Centre() + RandomVector(-0.7, 0.7);  // from the origin, at or past the body
    const auto depth = NearestIntersection(body, Eigen::Vector3d::Zero(), direction);
    bool passes_through = false;
    for (double t = 0.0; t < 2.0; t += 0.01) passes_through |= Contains(body, t * direction);
    if (passes_through) {
      ASSERT_TRUE(depth);
    }
    if (!depth) continue;
    ++hits;
    EXPECT_FALSE(Contains(body, (*depth - 1e-9) * direction));
    EXPECT_TRUE(Contains(body, (*depth + 1e-9) * direction) ||
                !Contains(body, (*depth + 1e-3) * direction));  // the latter: a graze
    EXPECT_FALSE(NearestIntersection(body, Eigen::Vector3d::Zero(), -direction));
  }
  EXPECT_GT(hits, 100);
}

TEST_P(BodyTest, NormalSupportsTheBodyAtItsPoint) {
  for (int trial = 0; trial < 200; ++trial) {
    const Landmark body = Shaped({Rigid3d{}, RandomVector(0.1, 0.8)});
    const Eigen::Vector3d point = SurfacePoint(GetParam(), body.half_axes, RandomUniform(-3.0, 3.0),
                                               RandomUniform(-1.5, 1.5));
    const Eigen::Vector3d normal = OutwardNormal(body, point);
    EXPECT_NEAR(normal.norm(), 1.0, 1e-12);
    EXPECT_NEAR(normal.dot(point), Support(GetParam(), body.half_axes, normal), 1e-12);
  }
}

}  // namespace
}  // namespace soslam

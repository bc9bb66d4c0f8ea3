// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/geometry/mirror_mapping.h"

#include <gtest/gtest.h>

#include "support/landmark_costs.h"
#include "support/shape_exponents.h"

namespace soslam {
namespace {

constexpr std::array<ShapeExponents, 6> kTestedExponents = {
    kCuboidExponent,         1.1, 1.5, kEllipsoidExponent, ShapeExponents(2.0, 1.0),
    ShapeExponents(1.6, 1.2)};

// The body around the optical axis, so that the sampled pixels hit it.
Landmark CentralLandmark(const ShapeExponents& shape_exponents = kEllipsoidExponent) {
  return {{RandomRotation(), Eigen::Vector3d(0, 0, 3) + RandomVector(-0.05, 0.05)},
          RandomVector(0.5, 0.9),
          shape_exponents};
}

Eigen::Vector2d RandomPixel() { return {RandomUniform(295, 345), RandomUniform(220, 265)}; }

TEST(VisibleSurface, PointIsOnTheSurfaceOnTheRayAndVisible) {
  for (int i = 0; i < 100; ++i) {
    const ShapeExponents p = kTestedExponents[static_cast<size_t>(i) % kTestedExponents.size()];
    const Landmark landmark = CentralLandmark(p);
    const VisibleSurface surface(TestCamera(), landmark);
    const Eigen::Vector2d pixel = RandomPixel();
    const auto point = surface.FromPixel(pixel);
    ASSERT_TRUE(point);
    EXPECT_NEAR(SurfaceNorm(landmark.half_axes, p, point->in_object), 1.0, 1e-9);
    EXPECT_LT((*surface.ToPixel(*point) - pixel).norm(), 1e-9);
    const double depth =
        *NearestIntersection(landmark, Eigen::Vector3d::Zero(), TestCamera().Ray(pixel));
    EXPECT_LT(
        (landmark.frame_from_object * point->in_object - depth * TestCamera().Ray(pixel)).norm(),
        1e-9);
  }
}

TEST(VisibleSurface, TangentPlaneAgreesAtTheContactAndToFirstOrderAround) {
  for (int i = 0; i < 100; ++i) {
    const VisibleSurface surface(TestCamera(), CentralLandmark());
    const Eigen::Vector2d pixel = RandomPixel();
    const auto contact = surface.FromPixel(pixel);
    EXPECT_LT((*surface.FromPixelOnTangentPlane(pixel, *contact) - contact->in_object).norm(),
              1e-9);
    const auto error = [&](double distance_px) {
      const Eigen::Vector2d near = pixel + Eigen::Vector2d(distance_px, 0);
      return (*surface.FromPixelOnTangentPlane(near, *contact) - surface.FromPixel(near)->in_object)
          .norm();
    };
    // Halving the distance quarters the error, eq. (23); higher orders take the rest.
    EXPECT_NEAR(error(0.5) / error(1.0), 0.25, 0.02);
  }
}

// A body of one of the tested exponents in turn, with a pixel that shows it.
struct SeenBody {
  explicit SeenBody(size_t number)
      : exponents(kTestedExponents[number % kTestedExponents.size()]),
        landmark(CentralLandmark(exponents)),
        surface(TestCamera(), landmark) {}

  ShapeExponents exponents;
  Landmark landmark;
  VisibleSurface surface;
  Eigen::Vector2d pixel = RandomPixel();
  Eigen::Vector3d along = RandomDirection();
};

TEST(VisibleSurface, DerivativesAgreeWithNumbers) {
  for (size_t i = 0; i < 80; ++i) {
    const SeenBody body(i);
    SCOPED_TRACE(body.exponents);
    const Eigen::Vector2d in_image = RandomVector(-1.0, 1.0).head<2>();
    const auto point = *body.surface.FromPixel(body.pixel);
    ExpectDerivative(body.surface.Derivative(point, body.along), body.landmark,
                     [&](const Landmark& moved) {
                       const VisibleSurface at(TestCamera(), moved);
                       return body.along.dot(at.FromPixel(body.pixel)->in_object);
                     });
    for (const double mirror_plane : {0.0, 0.2}) {
      const auto mirrored_at = [&](const VisibleSurface& at) {
        return at.MirrorImage(*at.FromPixel(body.pixel), mirror_plane);
      };
      const auto mirrored = mirrored_at(body.surface);
      ExpectDerivative(
          body.surface.Derivative(mirrored, body.along), body.landmark, [&](const Landmark& moved) {
            return body.along.dot(mirrored_at(VisibleSurface(TestCamera(), moved)).in_object);
          });
      ExpectDerivative(body.surface.PixelDerivative(mirrored, in_image), body.landmark,
                       [&](const Landmark& moved) {
                         const VisibleSurface at(TestCamera(), moved);
                         return in_image.dot(*at.ToPixel(mirrored_at(at)));
                       });
    }
  }
}

TEST(VisibleSurface, DerivativesOnTangentPlanesAgreeWithNumbers) {
  int checked = 0;
  for (size_t i = 0; i < 80; ++i) {
    const SeenBody body(i);
    SCOPED_TRACE(body.exponents);
    for (const bool is_mirrored : {false, true}) {
      const auto tangent_at = [&](const VisibleSurface& at) {
        const auto point = *at.FromPixel(body.pixel);
        return is_mirrored ? at.MirrorImage(point) : point;
      };
      const auto tangent = tangent_at(body.surface);
      const Eigen::Vector2d edge = *body.surface.ToPixel(tangent) + Eigen::Vector2d(3, -2);
      const auto on_plane = body.surface.FromPixelOnTangentPlane(edge, tangent);
      if (!on_plane) continue;  // the plane is nearly along the ray
      ExpectDerivative(body.surface.DerivativeOnTangentPlane(*on_plane, tangent, body.along),
                       body.landmark, [&](const Landmark& moved) {
                         const VisibleSurface at(TestCamera(), moved);
                         return body.along.dot(*at.FromPixelOnTangentPlane(edge, tangent_at(at)));
                       });
      ++checked;
    }
  }
  EXPECT_GT(checked, 120);
}

}  // namespace
}  // namespace soslam

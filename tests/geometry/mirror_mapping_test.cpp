// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/mirror_mapping.h"

#include <gtest/gtest.h>

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

// Central differences over the nine parameters; their error is about 1e-9 here.
template <typename Function>
void ExpectDerivative(const LandmarkJacobian1& analytic, const Landmark& landmark,
                      const Function& function) {
  constexpr double kStep = 1e-5;
  for (int i = 0; i < kLandmarkDof; ++i) {
    const LandmarkStep step = kStep * LandmarkStep::Unit(i);
    const double numeric =
        (function(Moved(landmark, step)) - function(Moved(landmark, -step))) / (2.0 * kStep);
    EXPECT_NEAR(analytic[i], numeric, 1e-6 * (1.0 + std::abs(numeric))) << i;
  }
}

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

TEST(VisibleSurface, MirrorImageIsTheMirrorOfTheLandmark) {
  const Landmark landmark = CentralLandmark();
  const VisibleSurface surface(TestCamera(), landmark);
  const auto point = surface.FromPixel(RandomPixel());
  const Eigen::Vector3d mirrored = point->in_object.cwiseProduct(Eigen::Vector3d(1, -1, 1));
  EXPECT_LT((surface.MirrorImage(*point).in_object - mirrored).norm(), 1e-12);
}

TEST(VisibleSurface, AMirrorPlaneBesideTheCentreMovesTheMirrorImageByTwiceItsDistance) {
  const Landmark landmark = CentralLandmark();
  const VisibleSurface surface(TestCamera(), landmark);
  const auto point = surface.FromPixel(RandomPixel());
  const double distance_m = 0.3 * MeanHalfAxis(landmark);
  const Eigen::Vector3d moved = surface.MirrorImage(*point, 0.3).in_object;
  EXPECT_LT(
      (moved - surface.MirrorImage(*point).in_object - Eigen::Vector3d(0.0, 2.0 * distance_m, 0.0))
          .norm(),
      1e-12);
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

TEST(VisibleSurface, PixelDerivativeOfAFixedPixelIsZero) {
  for (int i = 0; i < 20; ++i) {
    const VisibleSurface surface(TestCamera(), CentralLandmark());
    const auto point = *surface.FromPixel(RandomPixel());
    EXPECT_TRUE(point.IsOnRay());
    EXPECT_LT(surface.PixelDerivative(point, {1.0, 1.0}).norm(), 1e-9);
  }
}

TEST(VisibleSurface, AFaceOfTheCuboidIsItsTangentPlane) {
  // Its front looks at the camera.
  const Landmark landmark{
      {Eigen::Quaterniond(Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitY())),
       {0, 0, 3}},
      {0.5, 0.6, 0.7},
      kCuboidExponent};
  const VisibleSurface surface(TestCamera(), landmark);
  const auto contact = surface.FromPixel({300, 230});
  EXPECT_NEAR(contact->in_object.x(), 0.5, 1e-12);
  EXPECT_LT((*surface.FromPixelOnTangentPlane({340, 260}, *contact) -
             surface.FromPixel({340, 260})->in_object)
                .norm(),
            1e-12);
}

TEST(VisibleSurface, HiddenFacesOfTheCuboidLookAway) {
  for (int i = 0; i < 100; ++i) {
    const Landmark landmark = CentralLandmark(kCuboidExponent);
    const VisibleSurface surface(TestCamera(), landmark);
    const Eigen::Vector3d camera_in_object =
        landmark.frame_from_object.Inverse() * Eigen::Vector3d::Zero();
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {-1.0, 1.0}) {
        VisibleSurface::Point point{landmark.half_axes.cwiseProduct(RandomVector(-0.99, 0.99))};
        point.in_object[axis] = side * landmark.half_axes[axis];
        const bool is_hidden = side * camera_in_object[axis] <= landmark.half_axes[axis];
        // What is not hidden is what the pixel's ray meets first.
        const auto pixel = surface.ToPixel(point);
        ASSERT_TRUE(pixel);
        const auto seen = surface.FromPixel(*pixel);
        ASSERT_TRUE(seen);
        EXPECT_EQ((seen->in_object - point.in_object).norm() > 1e-9, is_hidden);
      }
    }
  }
}

TEST(VisibleSurface, CameraInsideOrLookingPastSeesNothing) {
  const Landmark around{Rigid3d(), {1, 1, 1}};
  EXPECT_FALSE(VisibleSurface(TestCamera(), around).FromPixel({320, 240}));
  const Landmark behind{{Eigen::Quaterniond::Identity(), {0, 0, -3}}, {1, 1, 1}};
  EXPECT_FALSE(VisibleSurface(TestCamera(), behind).FromPixel({320, 240}));
}

}  // namespace
}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/geometry/landmark.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/shape_exponents.h"

namespace soslam {
namespace {

void ExpectNear(const Box& one, const Box& other, double tolerance) {
  EXPECT_NEAR(one.x_min, other.x_min, tolerance);
  EXPECT_NEAR(one.y_min, other.y_min, tolerance);
  EXPECT_NEAR(one.x_max, other.x_max, tolerance);
  EXPECT_NEAR(one.y_max, other.y_max, tolerance);
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
  for (const ShapeExponents& p : kShapeExponents) {
    SCOPED_TRACE(p);
    for (int i = 0; i < 5; ++i) {
      const Landmark landmark = WithShape(RandomLandmarkInCamera(), p);
      const auto box = OutlineBox(TestCamera(), landmark);
      ASSERT_TRUE(box);
      Box sampled{1e9, 1e9, -1e9, -1e9};
      for (int k = 0; k < 40000; ++k) {
        const auto pixel = TestCamera().Project(RandomSurfacePoint(landmark));
        ASSERT_TRUE(pixel);
        sampled = {std::min(sampled.x_min, pixel->x()), std::min(sampled.y_min, pixel->y()),
                   std::max(sampled.x_max, pixel->x()), std::max(sampled.y_max, pixel->y())};
      }
      const Box margin{box->x_min - 1e-9, box->y_min - 1e-9, box->x_max + 1e-9, box->y_max + 1e-9};
      EXPECT_TRUE(margin.Contains({sampled.x_min, sampled.y_min}));
      EXPECT_TRUE(margin.Contains({sampled.x_max, sampled.y_max}));
      // Samples come within about 1/40000 of the extent of each tangent point; rounded edges reach
      // a thousandth of the size farther.
      ExpectNear(sampled, *box, 0.5);
    }
  }
}

// The ends of the dual conic C* = K [I | 0] Q* [I | 0]^T K^T: lines x = t with l^T C* l = 0.
TEST(OutlineBox, OfTheEllipsoidIsThatOfTheDualConic) {
  const Eigen::Matrix<double, 3, 4> projection =
      TestCamera().Intrinsics() * Rigid3d().Matrix().topRows<3>();
  for (int i = 0; i < 100; ++i) {
    const Landmark landmark = RandomLandmarkInCamera();
    const Eigen::Matrix3d conic = projection * DualQuadric(landmark) * projection.transpose();
    const auto end = [&](int axis, double sign) {
      const double middle = conic(axis, 2) / conic(2, 2);
      return middle + sign * std::sqrt(middle * middle - conic(axis, axis) / conic(2, 2));
    };
    ExpectNear(*OutlineBox(TestCamera(), landmark), {end(0, -1), end(1, -1), end(0, 1), end(1, 1)},
               1e-6);
  }
}

TEST(FindSilhouettePoint, ReachesFarthestInItsDirection) {
  const Camera camera = TestCamera();
  for (const ShapeExponents& p : kShapeExponents) {
    const Landmark landmark = WithShape(RandomLandmarkInCamera(), p);
    for (int i = 0; i < 20; ++i) {
      const double angle = RandomUniform(-3, 3);
      const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
      const auto end = FindSilhouettePoint(camera, landmark, direction, landmark.Centre());
      const auto same =
          FindSilhouettePoint(camera, landmark, direction, RandomSurfacePoint(landmark));
      ASSERT_TRUE(end && same);
      EXPECT_NEAR(same->end_px, end->end_px, 1e-8);
      EXPECT_NEAR(direction.dot(*camera.Project(end->point)), end->end_px, 1e-6);
      for (int k = 0; k < 100; ++k) {
        EXPECT_LT(direction.dot(*camera.Project(RandomSurfacePoint(landmark))), end->end_px + 1e-9);
      }
    }
  }
  const Landmark behind{{Eigen::Quaterniond::Identity(), {0, 0, -3}}, {1, 1, 1}};
  EXPECT_FALSE(FindSilhouettePoint(camera, behind, {1, 0}, behind.Centre()));
}

TEST(OutlineBox, NeedsTheWholeLandmarkInFront) {
  for (const ShapeExponents& p : kShapeExponents) {
    // An edge of the cuboid, in the camera's plane, reaches farther by the rounding.
    Landmark landmark = WithShape({Rigid3d(), {0.5, 0.5, 0.5}}, p);
    for (const double depth : {-2.0, 0.0, 0.4, 0.5}) {
      landmark.frame_from_object.translation.z() = depth;
      EXPECT_FALSE(OutlineBox(TestCamera(), landmark)) << depth;
    }
    landmark.frame_from_object.translation.z() = 0.51;
    EXPECT_TRUE(OutlineBox(TestCamera(), landmark));
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
    const Landmark turned = RotatedAboutZ({{rotation, Eigen::Vector3d::Zero()}, {1, 2, 3}}, turn);
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

// Its lowest point is on the plane, and the rest of it above.
TEST(ComputeSupportPlane, TouchesTheLowestPoint) {
  for (int i = 0; i < 20; ++i) {
    const Landmark landmark = Transform(RandomRigid(), RandomLandmarkInCamera());
    const Plane under = ComputeSupportPlane(landmark);
    EXPECT_NEAR(under.SignedDistance(FindSupportPoint(landmark, -under.normal).point), 0.0, 1e-12);
    EXPECT_GT(under.SignedDistance(landmark.Centre()), 0.0);
  }
}

TEST(RestingFace, FramesAreRotationsWithTheirAxisUp) {
  const Eigen::Vector3d up[] = {Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX(),
                                Eigen::Vector3d::UnitY()};
  for (const RestingFace face : kRestingFaces) {
    const Eigen::Matrix3d own_from_object = OwnFromObject(face);
    EXPECT_EQ(own_from_object * own_from_object.transpose(), Eigen::Matrix3d::Identity());
    EXPECT_EQ(own_from_object.determinant(), 1.0);
    EXPECT_EQ(own_from_object.col(2), up[static_cast<size_t>(face)]);
    for (const int own_axis : {0, 1, 2}) {
      EXPECT_EQ(std::abs(own_from_object(own_axis, AxisOfOwn(own_axis, face))), 1.0);
    }
  }
}

TEST(RestingFace, BodyInItsOwnAxesIsTheSame) {
  for (const RestingFace face : kRestingFaces) {
    for (int i = 0; i < 50; ++i) {
      const Eigen::Vector3d own_half_axes = RandomVector(0.1, 1.0);
      const Landmark landmark{RandomRigid(), HalfAxesOnFace(own_half_axes, face), 1.3, face};
      const Landmark own = InOwnAxes(landmark);
      EXPECT_EQ(own.half_axes, own_half_axes);
      EXPECT_EQ(own.rests_on, RestingFace::kBottom);
      for (int k = 0; k < 10; ++k) {
        const Eigen::Vector3d direction = RandomVector(-1.0, 1.0);
        EXPECT_NEAR(FindSupportPoint(own, direction).extent,
                    FindSupportPoint(landmark, direction).extent, 1e-12);
      }
    }
  }
}

TEST(HasExtent, RefusesFlakesAndWhatIsNowhere) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const Landmark landmark{RandomRigid(), {0.1, 0.2, 0.3}};
  EXPECT_TRUE(HasExtent(landmark));
  for (const double half_axis : {0.0, -0.1, kInfinity, kNaN}) {
    Landmark wrong = landmark;
    wrong.half_axes.y() = half_axis;
    EXPECT_FALSE(HasExtent(wrong)) << half_axis;
  }
  Landmark nowhere = landmark;
  nowhere.frame_from_object.translation.x() = kNaN;
  EXPECT_FALSE(HasExtent(nowhere));
}

}  // namespace
}  // namespace soslam

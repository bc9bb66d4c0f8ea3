// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/constraints/tangency.h"

#include <gtest/gtest.h>

#include "support/jacobians.h"
#include "support/random_scene.h"
#include "support/shape_exponents.h"

namespace soslam {
namespace {

constexpr double kSigmaFraction = 0.05;

BoxEdge RandomEdge() {
  const Box box{RandomUniform(100, 250), RandomUniform(100, 200), RandomUniform(350, 500),
                RandomUniform(250, 400)};
  return BoxEdges(TestCamera(), box, {}, kSigmaFraction)[TestRandom()() % 4];
}

double AtOwnDepth(const BoxEdge& edge, const Landmark& landmark, double bias_px = 0.0) {
  return Tangency(edge, landmark, FindTangentDepth(edge, landmark), bias_px, nullptr);
}

TEST(BoxEdges, PointOutOfTheBoxAndMeasurePixels) {
  const Camera camera = TestCamera();
  const Box box{100, 120, 300, 180};
  const auto edges = BoxEdges(camera, box, {true, false, false, true}, kSigmaFraction);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d point(RandomUniform(-1, 1), RandomUniform(-1, 1), RandomUniform(1, 4));
    const Eigen::Vector2d pixel = *camera.Project(point);
    const double outside[] = {box.x_min - pixel.x(), box.y_min - pixel.y(), pixel.x() - box.x_max,
                              pixel.y() - box.y_max};
    for (size_t k = 0; k < 4; ++k) {
      EXPECT_NEAR(edges[k].plane.dot(point) / point.z(), outside[k], 1e-9);
    }
  }
  EXPECT_TRUE(edges[0].is_one_sided && edges[3].is_one_sided);
  EXPECT_FALSE(edges[1].is_one_sided || edges[2].is_one_sided);
  EXPECT_DOUBLE_EQ(edges[0].sigma_px, 10.0);
  EXPECT_DOUBLE_EQ(edges[1].sigma_px, 3.0);
  // Not below a pixel.
  EXPECT_DOUBLE_EQ(BoxEdges(camera, {100, 100, 110, 110}, {}, 0.05)[2].sigma_px, 1.0);
}

TEST(WithoutBias, MovesMeasuredEdgesByFractionsOfTheBox) {
  const Box box{100, 200, 300, 600};
  EXPECT_EQ(WithoutBias(box, {}, {0.25, -0.5, 0.0, 0.125}), (Box{150, 0, 300, 550}));
  EXPECT_EQ(WithoutBias(box, {true, false, true, true}, {0.25, 0.25, 0.25, 0.25}),
            (Box{100, 300, 300, 600}));
}

TEST(BoxEdges, AreThoseOfTheBoxWithoutBias) {
  const Box box{100, 200, 300, 400};
  const std::array<bool, 4> is_one_sided = {false, false, true, false};
  const EdgeBias bias = {0.1, -0.05, 0.3, -0.2};
  const auto biased = BoxEdges(TestCamera(), box, is_one_sided, 0.02, bias);
  const auto corrected =
      BoxEdges(TestCamera(), WithoutBias(box, is_one_sided, bias), is_one_sided, 0.02);
  for (size_t i = 0; i < biased.size(); ++i) {
    EXPECT_EQ(biased[i].plane, corrected[i].plane);
    EXPECT_EQ(biased[i].is_one_sided, is_one_sided[i]);
    EXPECT_DOUBLE_EQ(biased[i].sigma_px, 4.0);  // of the detected box
  }
}

TEST(TangencyAtOwnDepth, IsThatAtTheTangentPointsDepth) {
  for (int i = 0; i < 50; ++i) {
    const Landmark landmark =
        WithShape(RandomLandmarkInCamera(), kShapeExponents[i % kShapeExponents.size()]);
    const BoxEdge edge = RandomEdge();
    LandmarkJacobian1 jacobian, expected_jacobian;
    const double expected =
        Tangency(edge, landmark, FindTangentDepth(edge, landmark), 0.0, &expected_jacobian);
    const auto found = TangencyAtOwnDepth(edge, landmark, &jacobian);
    ASSERT_TRUE(found);
    EXPECT_NEAR(*found, expected, 1e-12 * (1.0 + std::abs(expected)));
    EXPECT_LT((jacobian - expected_jacobian).norm(), 1e-9 * expected_jacobian.norm());
  }
}

TEST(TangencyAtOwnDepth, IsNoneBehindTheCamera) {
  Landmark landmark = RandomLandmarkInCamera();
  landmark.frame_from_object.translation = {0.0, 0.0, -5.0};
  const BoxEdge edge = RandomEdge();
  EXPECT_FALSE(TangencyAtOwnDepth(edge, landmark, nullptr));
  LandmarkJacobian1 jacobian;
  EXPECT_TRUE(std::isnan(OutlineExcess(edge, landmark, &jacobian)));
  EXPECT_TRUE(jacobian.array().isNaN().all());
}

TEST(Tangency, IsZeroForTheOutlineBoxAndGrowsByPixels) {
  const Camera camera = TestCamera();
  for (const ShapeExponents& p : kShapeExponents) {
    for (int i = 0; i < 20; ++i) {
      const Landmark landmark = WithShape(RandomLandmarkInCamera(), p);
      Box box = *OutlineBox(camera, landmark);
      for (const BoxEdge& edge : BoxEdges(camera, box, {}, kSigmaFraction)) {
        EXPECT_NEAR(AtOwnDepth(edge, landmark), 0.0, 1e-9) << p;
      }
      // An edge 0.01 px farther in is 0.01 px too far in, with the tangent point's depth.
      box.x_max -= 0.01;
      const BoxEdge edge = BoxEdges(camera, box, {}, kSigmaFraction)[2];
      EXPECT_NEAR(AtOwnDepth(edge, landmark) * edge.sigma_px, 0.01, 1e-4) << p;
    }
  }
}

// Edges far off are off by as many pixels, which they are to first order only for Tangency.
TEST(OutlineExcess, IsHowFarTheOutlineReachesOut) {
  const Camera camera = TestCamera();
  for (const ShapeExponents& p : kShapeExponents) {
    for (int i = 0; i < 20; ++i) {
      const Landmark landmark = WithShape(RandomLandmarkInCamera(), p);
      const Box outline = *OutlineBox(camera, landmark);
      const double outwards = RandomUniform(-0.4, 0.4) * outline.Width();
      Box box = outline;
      box.x_min -= outwards;
      box.x_max += outwards;
      const auto edges = BoxEdges(camera, box, {true, false, false, false}, kSigmaFraction);
      EXPECT_NEAR(OutlineExcess(edges[2], landmark, nullptr) * edges[2].sigma_px, -outwards, 1e-6);
      EXPECT_NEAR(OutlineExcess(edges[0], landmark, nullptr) * edges[0].sigma_px,
                  std::min(0.0, -outwards), 1e-6);
    }
  }
}

// Unlike Tangency's, whose depth is taken as known, the derivative is exact however far off the
// edge is. Step 1e-6; kinks rounded to a thousandth leave third derivatives of 1e6 px.
TEST(OutlineExcess, HasExactDerivatives) {
  constexpr double kStep = 1e-6;
  for (const double p : {1.5, 2.0}) {
    for (int i = 0; i < 20; ++i) {
      const Landmark landmark = WithShape(RandomLandmarkInCamera(), p);
      const BoxEdge edge = RandomEdge();
      LandmarkJacobian1 jacobian;
      jacobian.setConstant(std::numeric_limits<double>::quiet_NaN());
      OutlineExcess(edge, landmark, &jacobian);
      for (int k = 0; k < kLandmarkDof; ++k) {
        const auto at = [&](double step) {
          return OutlineExcess(edge, ApplyStep(landmark, step * LandmarkStep::Unit(k)), nullptr);
        };
        const double difference = (at(kStep) - at(-kStep)) / (2.0 * kStep);
        EXPECT_NEAR(jacobian[k], difference, 1e-4 * (1.0 + std::abs(difference))) << k;
      }
    }
  }
}

TEST(Tangency, BiasShiftsTheEdge) {
  const Landmark landmark = WithShape(RandomLandmarkInCamera(), 1.3);
  const Box box = *OutlineBox(TestCamera(), landmark);
  for (const BoxEdge& edge : BoxEdges(TestCamera(), box, {}, kSigmaFraction)) {
    EXPECT_NEAR(AtOwnDepth(edge, landmark, 2.5), -2.5 / edge.sigma_px, 1e-9);
  }
}

TEST(Tangency, OfAOneSidedEdgeCountsOnlyWhatIsMissing) {
  int reached = 0;
  for (int i = 0; i < 100; ++i) {
    const Landmark landmark = WithShape(RandomLandmarkInCamera(), RandomUniform(1, 2));
    const BoxEdge measured = RandomEdge();
    BoxEdge bound = measured;
    bound.is_one_sided = true;
    const double bias_px = RandomUniform(-3, 3);
    LandmarkJacobian1 of_measured, of_bound;
    const double expected = Tangency(measured, landmark, {3.0}, bias_px, &of_measured);
    const double found = Tangency(bound, landmark, {3.0}, bias_px, &of_bound);
    EXPECT_EQ(found, std::min(expected, 0.0));
    EXPECT_EQ(of_bound, expected > 0.0 ? LandmarkJacobian1::Zero().eval() : of_measured);
    reached += expected > 0.0 ? 1 : 0;
  }
  EXPECT_GT(reached, 10);
  EXPECT_LT(reached, 90);
}

// d^2 t / da^2 of a turn by a = contact . d^2 m / da^2 + (dm / da)^T H (dm / da), of which the last
// is meant.
TEST(TangencyCurvature, IsThatOfTheSquaredTangencyAcrossItsGradient) {
  constexpr double kStep = 1e-4;
  for (int i = 0; i < 50; ++i) {
    const Landmark landmark = WithShape(RandomLandmarkInCamera(), RandomUniform(1.2, 1.9));
    BoxEdge edge = RandomEdge();
    edge.plane.z() += 500.0;  // so that the body reaches outside
    LandmarkJacobian1 jacobian;
    const double tangency = Tangency(edge, landmark, {3.0}, 0.0, &jacobian);
    ASSERT_GT(tangency, 0.0);
    const auto rows = TangencyCurvature(edge, landmark, 3.0, tangency);
    const Eigen::Vector3d axis = RandomDirection();
    const auto at = [&](double angle) {
      Landmark turned = landmark;
      turned.frame_from_object.rotation =
          ExpRotation(angle * axis) * landmark.frame_from_object.rotation;
      return Tangency(edge, turned, {3.0}, 0.0, nullptr);
    };
    const double second = (at(kStep) - 2.0 * tangency + at(-kStep)) / (kStep * kStep);
    // A turned plane's normal moves on a circle: its second derivative, along the contact.
    const Eigen::Vector3d contact =
        FindSupportPoint(landmark, edge.plane).point - landmark.Centre();
    const double bends = axis.cross(axis.cross(edge.plane)).dot(contact) / (3.0 * edge.sigma_px);
    EXPECT_NEAR((rows * axis).squaredNorm(), tangency * (second - bends),
                1e-4 * tangency * (std::abs(second) + std::abs(bends)));
  }
}

TEST(TangencyCurvature, IsZeroInsideTheEdgeAndForEllipsoids) {
  const Landmark cuboid = WithShape(RandomLandmarkInCamera(), kCuboidExponent);
  const BoxEdge edge = RandomEdge();
  EXPECT_TRUE(TangencyCurvature(edge, cuboid, 3.0, -1.0).isZero(0.0));
  EXPECT_FALSE(TangencyCurvature(edge, cuboid, 3.0, 1.0).isZero(0.0));
  const Landmark ellipsoid = WithShape(cuboid, kEllipsoidExponent);
  EXPECT_TRUE(TangencyCurvature(edge, ellipsoid, 3.0, 1.0).isZero(0.0));
}

struct View {
  PoseBlock pose = ToParameterBlock(RandomRigid());
  Landmark initial_in_camera = RandomLandmarkInCamera();
  double bias_px = RandomUniform(-3, 3);
  double log_focal = 0.0;

  LandmarkBlock InWorld(const Landmark& in_camera) const {
    return ToParameterBlock(Transform(UnpackPose(pose.data()), in_camera));
  }
  // The parameter blocks of a residual, with this landmark in the world.
  std::vector<const double*> Blocks(const LandmarkBlock& landmark) const {
    return {pose.data(), landmark.data(), &bias_px, &log_focal};
  }
};

TEST(TangencyResidual, HasCorrectJacobiansBesideItsCurvatureRows) {
  for (int i = 0; i < 30; ++i) {
    View view;
    // Sharper bodies have derivatives that numbers do not follow.
    view.initial_in_camera.shape_exponents = RandomUniform(1.4, 2.0);
    BoxEdge edge = RandomEdge();
    edge.is_one_sided = i % 2 == 0;
    view.log_focal = 0.02 * (i - 15);
    ExpectCorrectJacobians(TangencyResidual(edge, view.initial_in_camera),
                           view.Blocks(view.InWorld(view.initial_in_camera)),
                           TangencyResidual::kCurvatureRows);
  }
}

// Their residuals are zero: they change neither cost nor gradient.
TEST(TangencyResidual, CurvatureRowsAddToTheInformationAlone) {
  int curved = 0;
  for (int i = 0; i < 30; ++i) {
    View view;
    view.initial_in_camera.shape_exponents = RandomUniform(1.0, 1.9);
    const LandmarkBlock landmark = view.InWorld(view.initial_in_camera);
    const auto blocks = view.Blocks(landmark);
    Eigen::Matrix<double, 3, kLandmarkSize, Eigen::RowMajor> rows;
    Eigen::Vector3d residuals;
    double* jacobians[] = {nullptr, rows.data(), nullptr, nullptr};
    ASSERT_TRUE(TangencyResidual(RandomEdge(), view.initial_in_camera)
                    .Evaluate(blocks.data(), residuals.data(), jacobians));
    EXPECT_EQ(residuals.tail<2>(), Eigen::Vector2d::Zero());
    curved += rows.bottomRows<2>().isZero(0.0) ? 0 : 1;
  }
  EXPECT_GT(curved, 5);
  EXPECT_LT(curved, 25);
}

// A tenth of the initial depth is the least that counts.
TEST(TangencyResidual, ComparesABodyBehindTheCameraAtATenthOfItsDepth) {
  const View view;
  const BoxEdge edge = RandomEdge();
  Landmark behind = view.initial_in_camera;
  behind.frame_from_object.translation.z() = -1.0;
  const LandmarkBlock landmark = view.InWorld(behind);
  const Eigen::VectorXd values =
      ResidualsAt(TangencyResidual(edge, view.initial_in_camera), view.Blocks(landmark));
  const double depth_m = 0.1 * FindTangentDepth(edge, view.initial_in_camera).depth_m;
  EXPECT_NEAR(values[0], Tangency(edge, behind, {depth_m}, view.bias_px, nullptr),
              1e-9 * (1.0 + std::abs(values[0])));
  ExpectCorrectJacobians(TangencyResidual(edge, view.initial_in_camera), view.Blocks(landmark),
                         TangencyResidual::kCurvatureRows);
}

TEST(TangencyResidual, RefusesHalfAxesBeyondNumbers) {
  const View view;
  LandmarkBlock landmark = view.InWorld(view.initial_in_camera);
  landmark[8] = 1000.0;
  Eigen::Vector3d values;
  for (const bool is_one_sided : {false, true}) {
    BoxEdge edge = RandomEdge();
    edge.is_one_sided = is_one_sided;
    const TangencyResidual residual(edge, view.initial_in_camera);
    EXPECT_FALSE(residual.Evaluate(view.Blocks(landmark).data(), values.data(), nullptr));
  }
}

}  // namespace
}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include <ceres/loss_function.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "soslam/initialisation/upright.h"
#include "support/jacobians.h"
#include "support/landmark_costs.h"
#include "support/shape_exponents.h"
#include "support/standing_landmarks.h"
#include "support/upright_bodies.h"

namespace soslam {
namespace {

void ExpectCorrectTermJacobian(const LandmarkTerm& term, const Landmark& landmark) {
  const LandmarkBlock block = ToParameterBlock(landmark);
  const std::shared_ptr<const LandmarkTerm> not_owned(std::shared_ptr<const void>(), &term);
  const LandmarkTermResidual for_ceres(not_owned, landmark.shape_exponents);
  ExpectCorrectJacobians(for_ceres, {block.data()});

  Eigen::VectorXd residuals(term.NumResiduals());
  LandmarkTerm::Jacobian jacobian(term.NumResiduals(), kLandmarkDof);
  jacobian.setConstant(std::numeric_limits<double>::quiet_NaN());  // what is left unwritten shows
  term.Evaluate(landmark, residuals, &jacobian);
  Eigen::VectorXd residuals_for_ceres(term.NumResiduals());
  const double* const blocks[] = {block.data()};
  ASSERT_TRUE(for_ceres.Evaluate(blocks, residuals_for_ceres.data(), nullptr));
  EXPECT_LT((residuals_for_ceres - residuals).norm(), 1e-9 * (1.0 + residuals.norm()));
  LandmarkModel model;
  term.AddTo(landmark, &model);
  ExpectSameModels(model, {0.5 * residuals.squaredNorm(), jacobian.transpose() * residuals,
                           jacobian.transpose() * jacobian});
  EXPECT_EQ(term.Value(landmark), 0.5 * residuals.squaredNorm());
}

// A landmark's own box, with errors of up to 10 % of its sides; any of its edges may be a bound.
std::array<BoxEdge, 4> EdgesNear(const Landmark& landmark) {
  const Box box = Disturbed(*OutlineBox(TestCamera(), landmark), 0.1);
  const auto bits = TestRandom()();
  return BoxEdges(TestCamera(), box,
                  {(bits & 1U) != 0, (bits & 2U) != 0, (bits & 4U) != 0, (bits & 8U) != 0},
                  kDetectionSigmaFraction);
}

// Whether no edge is where its residual bends within the steps of numeric differences: its plane
// along a face of the body, or the body just at a bound.
bool AreOffTheKinks(const std::array<BoxEdge, 4>& edges, const Landmark& landmark) {
  return std::all_of(edges.begin(), edges.end(), [&](const BoxEdge& edge) {
    BoxEdge measured = edge;
    measured.is_one_sided = false;
    const double outside =
        Tangency(measured, landmark, FindTangentDepth(edge, landmark), 0.0, nullptr);
    if (edge.is_one_sided && std::abs(outside) < 0.1) return false;
    const Eigen::Vector3d in_object =
        landmark.frame_from_object.rotation.conjugate() * edge.plane.normalized();
    return landmark.shape_exponents == kEllipsoidExponent || in_object.cwiseAbs().minCoeff() > 0.1;
  });
}

TEST(BoxTerm, JacobianAgreesWithNumbers) {
  for (const ShapeExponents& p : kShapeExponents) {
    SCOPED_TRACE(p);
    int checked = 0;
    while (checked < 20) {
      const Landmark landmark = WithShape(RandomLandmarkInCamera(), p);
      const auto edges = EdgesNear(landmark);
      if (!AreOffTheKinks(edges, landmark)) continue;
      ExpectCorrectTermJacobian(BoxTerm(edges, landmark), landmark);
      ++checked;
    }
  }
}

TEST(RatioTerm, JacobianAgreesWithNumbers) {
  for (int i = 0; i < 20; ++i) {
    const ShapePrior prior{RandomVector(0.3, 3.0).head<2>(), RandomVector(0.05, 0.5).head<2>(),
                           kCuboidExponent, i % 2 == 0 ? 0.0 : RandomUniform(-0.95, 0.95)};
    ExpectCorrectTermJacobian(RatioTerm(prior), RandomLandmarkInCamera());
  }
}

Landmark Leaning(const Landmark& upright) {
  Landmark landmark = upright;
  landmark.frame_from_object.rotation =
      ExpRotation(RandomVector(-0.4, 0.4)) * upright.frame_from_object.rotation;
  return landmark;
}

TEST(YawTerm, JacobianAgreesWithNumbers) {
  for (int i = 0; i < 20; ++i) {
    const ObservedBody body(kCuboidExponent);
    const Landmark landmark = Leaning(body.truth);
    const double yaw = Yaw(body.plane.normal, landmark.frame_from_object.rotation);
    const YawTerm term(body.plane, {yaw + RandomUniform(-1.4, 1.4), 0.2});
    ExpectCorrectTermJacobian(term, landmark);
  }
}

constexpr int kYawsOfCosts = 36;

// A few harmonics of twice the yaw, the lowest of all of them zero.
std::vector<double> RandomYawCosts() {
  std::vector<double> costs(kYawsOfCosts, 0.0);
  for (int harmonic = 1; harmonic <= 3; ++harmonic) {
    const double amplitude = RandomUniform(0.0, 3.0), phase = RandomUniform(-3.0, 3.0);
    for (int i = 0; i < kYawsOfCosts; ++i) {
      const double yaw = std::numbers::pi * i / kYawsOfCosts;
      costs[i] += amplitude * std::cos(2.0 * harmonic * yaw - phase);
    }
  }
  const double lowest = *std::ranges::min_element(costs);
  for (double& cost : costs) cost -= lowest;
  return costs;
}

Landmark AtYaw(const Plane& plane, double yaw) {
  Landmark landmark;
  landmark.frame_from_object.rotation = UprightRotation(plane.normal, yaw);
  return landmark;
}

TEST(YawCostTerm, JacobianAgreesWithNumbers) {
  int checked = 0;
  while (checked < 20) {
    const ObservedBody body(kCuboidExponent);
    const Landmark landmark = Leaning(body.truth);
    const double yaw = Yaw(body.plane.normal, landmark.frame_from_object.rotation);
    const double step = yaw * kYawsOfCosts / std::numbers::pi;
    if (std::abs(step - std::round(step)) < 0.02) continue;  // second derivatives jump there
    const YawCostTerm term(body.plane, RandomYawCosts());
    if (term.Value(landmark) < 1e-3) continue;
    ExpectCorrectTermJacobian(term, landmark);
    ++checked;
  }
}

TEST(YawCostTerm, CostsAreThoseOfTheGridAndRepeatAfterHalfATurn) {
  for (int i = 0; i < 10; ++i) {
    const Plane plane = RandomPlane();
    std::vector<double> costs = RandomYawCosts();
    const YawCostTerm raised(plane, costs);
    for (double& cost : costs) cost += 1.0;
    const YawCostTerm term(plane, costs);
    const double raise = raised.Value(AtYaw(plane, 0.0)) - (costs[0] - 1.0);
    EXPECT_GE(raise, 0.0);
    EXPECT_LT(raise, 0.1);
    for (int k = 0; k < kYawsOfCosts; ++k) {
      const Landmark landmark = AtYaw(plane, std::numbers::pi * k / kYawsOfCosts);
      EXPECT_NEAR(term.Value(landmark), costs[k], 1e-6);
      EXPECT_NEAR(raised.Value(landmark), costs[k] - 1.0 + raise, 1e-6);
    }
    const Landmark landmark = AtYaw(plane, RandomUniform(-3.0, 3.0));
    const Landmark turned = RotatedAboutZ(landmark, std::numbers::pi);
    EXPECT_NEAR(term.Value(landmark), term.Value(turned), 1e-9);
  }
}

// A root that crossed zero would hold the yaw there, whatever else is known of it.
TEST(YawCostTerm, InformationIsBoundedWhereTheCostIsLowest) {
  for (int i = 0; i < 10; ++i) {
    const Plane plane = RandomPlane();
    std::vector<double> costs(kYawsOfCosts);
    for (double& cost : costs) cost = RandomUniform(0.0, 5.0);
    costs[5] = 0.0;
    costs[4] = 4.0;  // much steeper on one side
    costs[6] = 0.5;
    const YawCostTerm term(plane, costs);
    // The square of a slope is at most twice the cost times the largest second derivative.
    const double steps = kYawsOfCosts / std::numbers::pi;
    const double bound = 12.0 * 5.0 * steps * steps;
    for (int k = 0; k < 3600; ++k) {
      const Landmark landmark = AtYaw(plane, std::numbers::pi * k / 3600.0);
      Eigen::VectorXd residuals(1);
      LandmarkTerm::Jacobian jacobian(1, kLandmarkDof);
      term.Evaluate(landmark, residuals, &jacobian);
      ASSERT_TRUE(std::isfinite(residuals[0]));
      ASSERT_LT(jacobian.squaredNorm(), bound);
    }
  }
}

TEST(LengthTerm, JacobianAgreesWithNumbers) {
  for (int i = 0; i < 20; ++i) {
    const LogNormal length_m{RandomUniform(0.1, 2.0), RandomUniform(0.05, 0.5)};
    for (const Eigen::Index axis : {0, 1, 2}) {
      ExpectCorrectTermJacobian(LengthTerm({length_m, axis}), RandomLandmarkInCamera());
    }
  }
}

TEST(LengthTerm, CountsStandardDeviationsOfTheLogarithm) {
  Landmark landmark;
  landmark.half_axes.z() = 0.5 * 0.8 * std::exp(1.5 * 0.3);
  EXPECT_NEAR(Residuals(LengthTerm({{0.8, 0.3}, 2}), landmark)[0], 1.5, 1e-12);
}

TEST(RatioTerm, CostIsThatOfTheCovariance) {
  for (int i = 0; i < 20; ++i) {
    const ShapePrior prior{RandomVector(0.3, 3.0).head<2>(), RandomVector(0.05, 0.5).head<2>(),
                           kCuboidExponent, RandomUniform(-0.95, 0.95)};
    const Landmark landmark = RandomLandmarkInCamera();
    const Eigen::Vector2d error =
        (landmark.half_axes.head<2>().array() / landmark.half_axes.z() / prior.ratio.array())
            .log()
            .matrix();
    Eigen::Matrix2d covariance = prior.log_sigma.cwiseAbs2().asDiagonal();
    covariance(0, 1) = covariance(1, 0) =
        prior.log_correlation * prior.log_sigma.x() * prior.log_sigma.y();
    const double expected = error.dot(covariance.inverse() * error);
    EXPECT_NEAR(Residuals(RatioTerm(prior), landmark).squaredNorm() / expected, 1.0, 1e-9);
  }
}

// The axis of the world at an angle from an upright landmark's front.
Eigen::Vector3d AxisAt(const Plane& plane, const Landmark& landmark, double angle) {
  const double yaw = Yaw(plane.normal, landmark.frame_from_object.rotation) + angle;
  return UprightRotation(plane.normal, yaw) * Eigen::Vector3d::UnitX();
}

TEST(AxisTerm, JacobianAgreesWithNumbers) {
  for (int i = 0; i < 50; ++i) {
    const Plane plane = RandomPlane();
    const Landmark landmark = Leaning(RandomStanding(plane));
    const AxisTerm term(plane, AxisAt(plane, landmark, RandomUniform(-3.1, 3.1)),
                        RandomUniform(0.1, 10.0));
    ExpectCorrectTermJacobian(term, landmark);
  }
}

TEST(AxisTerm, CostsItsWeightHalfWayBetweenAxes) {
  for (int i = 0; i < 50; ++i) {
    const Plane plane = RandomPlane();
    const Landmark landmark = RandomStanding(plane);
    const double weight = RandomUniform(0.1, 10.0);
    const double angle = RandomUniform(-3.1, 3.1);
    EXPECT_NEAR(AxisTerm(plane, AxisAt(plane, landmark, angle), weight).Value(landmark),
                weight * std::pow(std::sin(2.0 * angle), 2), 1e-9);
  }
}

// A landmark in a reference frame, another frame from which a camera sees it, and its box there.
struct ReferenceView {
  Rigid3d camera_from_reference = RandomRigid();
  Landmark in_camera = WithShape(RandomLandmarkInCamera(), RandomUniform(1.3, 2.0));
  std::array<BoxEdge, 4> edges = EdgesNear(in_camera);
  Landmark in_reference = Transform(camera_from_reference.Inverse(), in_camera);
  double delta = RandomUniform(0.5, 4.0);
  double weight = RandomUniform(0.1, 2.0);
  RobustViewTerm term{std::make_unique<BoxTerm>(edges, in_camera), camera_from_reference, delta,
                      weight};

  // Residuals of the box in its own camera frame, without loss and weight.
  Eigen::VectorXd PlainResiduals() const { return Residuals(BoxTerm(edges, in_camera), in_camera); }
};

TEST(RobustViewTerm, HalfOfItsSquareIsTheWeightedHuberLoss) {
  int within = 0, beyond = 0;
  for (int i = 0; i < 100; ++i) {
    const ReferenceView view;
    const Eigen::VectorXd plain = view.PlainResiduals();
    const Eigen::VectorXd robust = Residuals(view.term, view.in_reference);
    ASSERT_EQ(robust.size(), plain.size());
    const ceres::HuberLoss huber(view.delta);
    for (Eigen::Index k = 0; k < plain.size(); ++k) {
      double loss[3];
      huber.Evaluate(plain[k] * plain[k], loss);
      EXPECT_NEAR(robust[k] * robust[k], view.weight * loss[0], 1e-8 * (1.0 + loss[0]));
      EXPECT_GE(robust[k] * plain[k], 0.0);
      within += plain[k] != 0.0 && std::abs(plain[k]) < view.delta ? 1 : 0;
      beyond += std::abs(plain[k]) > view.delta ? 1 : 0;
    }
  }
  EXPECT_GT(within, 50);
  EXPECT_GT(beyond, 50);
}

TEST(ViewCost, IsTheViewTermWithoutALoss) {
  for (int i = 0; i < 50; ++i) {
    const ReferenceView view;
    const auto box = [&] { return std::make_unique<BoxTerm>(view.edges, view.in_camera); };
    const RobustViewTerm expected(box(), view.camera_from_reference,
                                  std::numeric_limits<double>::infinity(), view.weight);
    const ViewCost cost(box(), view.camera_from_reference, view.weight);
    LandmarkModel of_term, of_cost;
    expected.AddTo(view.in_reference, &of_term);
    cost.AddTo(view.in_reference, &of_cost);
    ExpectSameModels(of_cost, of_term);
    EXPECT_NEAR(cost.Value(view.in_reference), of_term.cost, 1e-9 * (1.0 + of_term.cost));
  }
}

TEST(RobustViewTerm, JacobianAgreesWithNumbers) {
  int checked = 0;
  while (checked < 50) {
    const ReferenceView view;
    // Where the loss turns from square to linear, its slope bends.
    const bool at_delta = ((view.PlainResiduals().array().abs() - view.delta).abs() < 0.1).any();
    if (at_delta || !AreOffTheKinks(view.edges, view.in_camera)) continue;
    ExpectCorrectTermJacobian(view.term, view.in_reference);
    ++checked;
  }
}

}  // namespace
}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/axis_cost_term.h"

#include <gtest/gtest.h>

#include "constraints/tangent_space.h"
#include "initialisation/landmark_term_residual.h"
#include "mapping/cost_function_term.h"

namespace soslam {
namespace {

struct Derivatives {
  double cost;
  Eigen::Matrix<double, kLandmarkDof, 1> gradient = decltype(gradient)::Zero();
  Eigen::Matrix<double, kLandmarkDof, kLandmarkDof> hessian = decltype(hessian)::Zero();

  Derivatives(const Term& term, Hessian kind) {
    TermPlaces places;
    places.gradient[0] = gradient.data();
    places.hessian[0][0] = hessian.data();
    cost = term.Linearise(kind, places);
  }
};

constexpr double kWeight = 1.7;

class AxisCostTermTest : public testing::TestWithParam<double> {
 protected:
  AxisCostTermTest() {
    Landmark landmark;
    landmark.half_axes = {0.2, 0.3, 0.4};
    landmark.frame_from_object = {UprightRotation(plane_.normal, GetParam()), {1.0, 2.0, 0.4}};
    values_ = Pack(landmark);
  }

  Plane plane_;
  decltype(Pack(Landmark())) values_;
  AxisCostTerm term_{0, values_.data(), plane_, kWeight};
};

TEST_P(AxisCostTermTest, IsWhatItsResidualSaysFarFromAMinimum) {
  const CostFunctionTerm by_residual(
      std::make_unique<LandmarkTermResidual>(
          std::make_unique<AxisTerm>(plane_, WorldAxis(plane_), kWeight)),
      {{0, VariableKind::kLandmark, values_.data()}}, 1e9);
  const Derivatives expected(by_residual, Hessian::kFar);
  const Derivatives actual(term_, Hessian::kFar);
  EXPECT_NEAR(actual.cost, expected.cost, 1e-12);
  EXPECT_NEAR(term_.Cost(), expected.cost, 1e-12);
  EXPECT_TRUE(actual.gradient.isApprox(expected.gradient, 1e-9));
  EXPECT_TRUE(actual.hessian.isApprox(expected.hessian, 1e-9));
}

TEST_P(AxisCostTermTest, HasTheSecondDerivativeOfItsCostNearAMinimum) {
  const Derivatives here(term_, Hessian::kNear);
  constexpr double kStep = 1e-4;
  Eigen::Matrix<double, kLandmarkDof, 1> turn = decltype(turn)::Zero();
  turn.head<3>() = kStep * plane_.normal;
  Move(VariableKind::kLandmark, turn.data(), values_.data());
  const Eigen::Matrix<double, kLandmarkDof, 1> changed =
      Derivatives(term_, Hessian::kNear).gradient - here.gradient;
  EXPECT_TRUE(changed.isApprox(here.hessian * turn, 1e-2));
}

INSTANTIATE_TEST_SUITE_P(Yaws, AxisCostTermTest, testing::Values(0.1, 0.5, 0.7, 2.0));

}  // namespace
}  // namespace soslam

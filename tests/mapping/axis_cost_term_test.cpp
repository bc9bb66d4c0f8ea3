// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/axis_cost_term.h"

#include <gtest/gtest.h>

#include <limits>
#include <optional>
#include <tuple>

#include "constraints/tangent_space.h"
#include "support/cost_function_term.h"
#include "support/landmark_term_residual.h"

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

// Normal and yaw.
using NormalAndYaw = std::tuple<Eigen::Vector3d, double>;

class AxisCostTermTest : public testing::TestWithParam<NormalAndYaw> {
 protected:
  AxisCostTermTest() {
    plane_.normal = std::get<0>(GetParam()).normalized();
    Landmark landmark;
    landmark.half_axes = {0.2, 0.3, 0.4};
    landmark.frame_from_object = {UprightRotation(plane_.normal, std::get<1>(GetParam())),
                                  {1.0, 2.0, 0.4}};
    values_ = ToParameterBlock(landmark);
    term_.emplace(0, values_.data(), plane_, kWeight);
  }

  Derivatives TurnedBy(double angle) {
    const auto here = values_;
    Eigen::Matrix<double, kLandmarkDof, 1> turn = decltype(turn)::Zero();
    turn.head<3>() = angle * plane_.normal;
    Move(VariableKind::kLandmark, turn.data(), values_.data());
    const Derivatives derivatives(*term_, Hessian::kNear);
    values_ = here;
    return derivatives;
  }

  Plane plane_;
  decltype(ToParameterBlock(Landmark())) values_;
  std::optional<AxisCostTerm> term_;
};

TEST_P(AxisCostTermTest, IsWhatItsResidualSaysFarFromAMinimum) {
  const CostFunctionTerm by_residual(
      std::make_unique<LandmarkTermResidual>(
          std::make_unique<AxisTerm>(plane_, WorldAxis(plane_), kWeight)),
      {{0, VariableKind::kLandmark, values_.data()}}, 1e9);
  const Derivatives expected(by_residual, Hessian::kFar);
  const Derivatives actual(*term_, Hessian::kFar);
  EXPECT_NEAR(actual.cost, expected.cost, 1e-12);
  EXPECT_NEAR(term_->Cost(), expected.cost, 1e-12);
  EXPECT_TRUE(actual.gradient.isApprox(expected.gradient, 1e-9));
  EXPECT_TRUE(actual.hessian.isApprox(expected.hessian, 1e-9));
}

TEST_P(AxisCostTermTest, HasTheSecondDerivativeOfItsCostNearAMinimum) {
  const Derivatives here(*term_, Hessian::kNear);
  constexpr double kStep = 1e-4;
  const Eigen::Matrix<double, kLandmarkDof, 1> slope =
      (TurnedBy(kStep).gradient - TurnedBy(-kStep).gradient) / (2.0 * kStep);
  // What central differences leave out is some 16 / 6 step^2 of it.
  EXPECT_NEAR(plane_.normal.dot(slope.head<3>()),
              plane_.normal.dot(here.hessian.topLeftCorner<3, 3>() * plane_.normal), 1e-6);
}

TEST_P(AxisCostTermTest, OfAHeldLandmarkIsNothingButACost) {
  EXPECT_EQ(term_->Linearise(Hessian::kNear, TermPlaces()), term_->Cost());
}

TEST_P(AxisCostTermTest, IsInfiniteWhereItIsNotDefined) {
  values_[0] = std::numeric_limits<double>::quiet_NaN();
  const Derivatives nowhere(*term_, Hessian::kNear);
  EXPECT_EQ(nowhere.cost, std::numeric_limits<double>::infinity());
  EXPECT_EQ(term_->Cost(), std::numeric_limits<double>::infinity());
  EXPECT_TRUE(nowhere.gradient.isZero(0.0));
}

// The horizontal axis that yaw counts from is another one where the normal is nearly x.
INSTANTIATE_TEST_SUITE_P(NormalsAndYaws, AxisCostTermTest,
                         testing::Combine(testing::Values(Eigen::Vector3d(0.0, 0.0, 1.0),
                                                          Eigen::Vector3d(0.2, -0.3, 0.9),
                                                          Eigen::Vector3d(0.95, 0.2, 0.1)),
                                          testing::Values(0.1, 0.5, 0.7, 2.0)));

}  // namespace
}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "constraints/tangent_space.h"

#include <gtest/gtest.h>

#include "support/random.h"

namespace soslam {
namespace {

constexpr std::array kKinds = {VariableKind::kPose, VariableKind::kLandmark, VariableKind::kNormal,
                               VariableKind::kOffset, VariableKind::kBias};

std::vector<double> RandomValues(VariableKind kind) {
  if (kind == VariableKind::kNormal) {
    const Eigen::Vector3d normal = RandomPlane().normal;
    return {normal.begin(), normal.end()};
  }
  const LandmarkBlock values = ToParameterBlock(RandomLandmarkInCamera());  // a pose first
  return {values.begin(), values.begin() + NumValues(kind)};
}

// Central differences over 1e-5: exact to 1e-10.
TEST(TangentSpace, StepsLeadWhereTheirDerivativesSay) {
  constexpr double kStep = 1e-5;
  for (const VariableKind kind : kKinds) {
    const std::vector<double> values = RandomValues(kind);
    const ValuesByStep by_step = ByStep(kind, values.data());
    ASSERT_EQ(by_step.rows(), NumValues(kind));
    ASSERT_EQ(by_step.cols(), NumTangents(kind));
    for (int i = 0; i < NumTangents(kind); ++i) {
      const auto at = [&](double length) {
        std::vector<double> moved = values;
        const Eigen::VectorXd step = length * Eigen::VectorXd::Unit(NumTangents(kind), i);
        Move(kind, step.data(), moved.data());
        return Eigen::VectorXd(Eigen::Map<Eigen::VectorXd>(moved.data(), NumValues(kind)));
      };
      EXPECT_LT((by_step.col(i) - (at(kStep) - at(-kStep)) / (2.0 * kStep)).norm(), 1e-8);
    }
  }
}

template <VariableKind kKind>
void ExpectToChain() {
  const std::vector<double> values = RandomValues(kKind);
  const auto by_values = JacobianRows<5, NumValues(kKind)>::Random().eval();
  const auto by_steps = ChainedToSteps<kKind, 5>(values.data(), by_values);
  EXPECT_TRUE(by_steps.isApprox(by_values * ByStep(kKind, values.data()), 1e-14));
}

TEST(TangentSpace, ChainsJacobiansToSteps) {
  ExpectToChain<VariableKind::kPose>();
  ExpectToChain<VariableKind::kLandmark>();
  ExpectToChain<VariableKind::kNormal>();
  ExpectToChain<VariableKind::kOffset>();
  ExpectToChain<VariableKind::kBias>();
}

TEST(TangentSpace, RotationsTurnFromTheLeftAndStayUnit) {
  const Rigid3d pose = RandomRigid();
  PoseBlock values = ToParameterBlock(pose);
  const Eigen::Matrix<double, kPoseDof, 1> step{0.3, -0.2, 0.5, 1.0, 2.0, 3.0};
  Move(VariableKind::kPose, step.data(), values.data());
  const Rigid3d moved = UnpackPose(values.data());
  EXPECT_LT(moved.rotation.angularDistance(ExpRotation(step.head<3>()) * pose.rotation), 1e-12);
  EXPECT_LT((moved.translation - pose.translation - step.tail<3>()).norm(), 1e-12);
  EXPECT_NEAR(Eigen::Map<Eigen::Vector4d>(values.data()).norm(), 1.0, 1e-15);

  Eigen::Vector3d normal = RandomPlane().normal;
  const Eigen::Vector2d far(0.4, -0.7);
  Move(VariableKind::kNormal, far.data(), normal.data());
  EXPECT_NEAR(normal.norm(), 1.0, 1e-15);
}

}  // namespace
}  // namespace soslam

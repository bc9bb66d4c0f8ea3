// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/mapping/normal_equations.h"

#include <ceres/ceres.h>
#include <ceres/normal_prior.h>
#include <gtest/gtest.h>

#include <Eigen/QR>

#include "support/random.h"

namespace soslam {
namespace {

// Residuals matrix * (a, b, c) - target of three blocks of two values each.
class LinearResidual final : public ceres::SizedCostFunction<9, 2, 2, 2> {
 public:
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    Eigen::Map<Eigen::Matrix<double, 9, 1>> values(residuals);
    values = -target_;
    for (int block = 0; block < 3; ++block) {
      const auto columns = matrix_.middleCols<2>(2 * block);
      values += columns * Eigen::Map<const Eigen::Vector2d>(blocks[block]);
      if (jacobians == nullptr || jacobians[block] == nullptr) continue;
      Eigen::Map<Eigen::Matrix<double, 9, 2, Eigen::RowMajor>> jacobian(jacobians[block]);
      jacobian = columns;
    }
    return true;
  }
  // The values of the first `free` blocks at the lowest cost, the others being zero.
  Eigen::VectorXd Minimum(Eigen::Index free) const {
    return matrix_.leftCols(2 * free).colPivHouseholderQr().solve(target_);
  }
  double LowestCost(Eigen::Index free) const {
    return 0.5 * (matrix_.leftCols(2 * free) * Minimum(free) - target_).squaredNorm();
  }

 private:
  Eigen::Matrix<double, 9, 6> matrix_ = Eigen::Matrix<double, 9, 6>::Random();
  Eigen::Matrix<double, 9, 1> target_ = Eigen::Matrix<double, 9, 1>::Random();
};

// Many more residuals than are linearised together.
TEST(NormalEquationsTest, AreSumsOverAllResiduals) {
  constexpr int kResiduals = 25'000;
  double value[1] = {2.0};
  ceres::Problem problem;
  for (int i = 0; i < kResiduals; ++i) {
    problem.AddResidualBlock(
        new ceres::NormalPrior(ceres::Matrix::Constant(1, 1, 3.0), ceres::Vector::Constant(1, 1.0)),
        nullptr, value);
  }
  const NormalEquations equations = MakeNormalEquations({value}, CurvatureRows::kWith, &problem);
  EXPECT_EQ(equations.matrix.coeff(0, 0), 9.0 * kResiduals);
  EXPECT_EQ(equations.gradient, Eigen::VectorXd::Constant(1, 9.0 * kResiduals));
}

class ScoreTestTest : public testing::Test {
 protected:
  ScoreTestTest() {
    problem_.AddResidualBlock(residual_, nullptr, values_, values_ + 2, values_ + 4);
    problem_.SetParameterBlockConstant(values_ + 2);
    problem_.SetParameterBlockConstant(values_ + 4);
  }

  double values_[6] = {};
  LinearResidual* residual_ = new LinearResidual;  // the problem's
  ceres::Problem problem_;
};

// The variable blocks may be anywhere.
TEST_F(ScoreTestTest, StepsToTheMinimumOfALinearProblem) {
  values_[0] = RandomUniform(-1.0, 1.0);
  values_[1] = RandomUniform(-1.0, 1.0);
  const Eigen::Vector2d variable(values_);
  const ScoreTest score({values_ + 2, values_ + 4}, &problem_);
  EXPECT_NEAR(score.Step({values_ + 2}), residual_->LowestCost(1) - residual_->LowestCost(2), 1e-6);
  EXPECT_NEAR((Eigen::Map<Eigen::Vector2d>(values_ + 2) - residual_->Minimum(2).tail<2>()).norm(),
              0.0, 1e-6);
  EXPECT_EQ(Eigen::Map<Eigen::Vector2d>(values_), variable);
  EXPECT_EQ(Eigen::Map<Eigen::Vector2d>(values_ + 4), Eigen::Vector2d::Zero());
  Eigen::Map<Eigen::Vector4d>(values_ + 2).setZero();
  EXPECT_NEAR(score.Step({values_ + 2, values_ + 4}),
              residual_->LowestCost(1) - residual_->LowestCost(3), 1e-6);
  EXPECT_NEAR((Eigen::Map<Eigen::Vector4d>(values_ + 2) - residual_->Minimum(3).tail<4>()).norm(),
              0.0, 1e-6);
}

TEST_F(ScoreTestTest, WhatNoResidualDeterminesStays) {
  double alone[1] = {2.0};
  problem_.AddParameterBlock(alone, 1);
  problem_.SetParameterBlockConstant(alone);
  const ScoreTest score({values_ + 2, alone}, &problem_);
  EXPECT_NEAR(score.Step({alone}), 0.0, 1e-12);
  EXPECT_EQ(alone[0], 2.0);
  EXPECT_TRUE(problem_.IsParameterBlockConstant(alone));
}

// The blocks move on their manifolds.
TEST(ScoreTestOfUnitVectors, MovesThemOnTheSphere) {
  double direction[3] = {1.0, 0.0, 0.0};
  ceres::Problem problem;
  const Eigen::Vector3d target(0.9, 0.1, -0.2);
  problem.AddResidualBlock(new ceres::NormalPrior(Eigen::Matrix3d::Identity(), target), nullptr,
                           direction);
  problem.SetManifold(direction, new ceres::SphereManifold<3>);
  problem.SetParameterBlockConstant(direction);
  const double gain = ScoreTest({direction}, &problem).Step({direction});
  const Eigen::Vector3d after(direction);
  EXPECT_NEAR(after.norm(), 1.0, 1e-12);
  EXPECT_LT(after.cross(target).norm(), 0.02);  // to first order in 14 degrees
  EXPECT_NEAR(gain, 0.5 * (0.1 * 0.1 + 0.2 * 0.2), 1e-6);
}

}  // namespace
}  // namespace soslam

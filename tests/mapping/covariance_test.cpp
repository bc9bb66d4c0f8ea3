// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/mapping/covariance.h"

#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "soslam/mapping/back_end_problem.h"
#include "support/cuboid_map.h"
#include "support/scene.h"

namespace soslam {
namespace {

// Two floors that share a normal and six objects on them, with poses and biases to estimate.
class MarginalCovariancesTest : public testing::Test {
 protected:
  static Sequence Estimated() {
    const Scene scene = WithShelf(RandomScene(2, 6, 30, {Shape::kBox}), 0.4);
    return OnPlanesToEstimate(SyntheticSequence(scene, /*noise=*/true));
  }
  static OptimiseOptions Options() {
    OptimiseOptions options = TangencyOptions();
    options.detector_bias_sigma_px = 1.0;
    return options;
  }

  const Sequence sequence_ = Estimated();
  const BackEndInput input_ = TruthInput(sequence_);
  const OptimiseOptions options_ = Options();
  BackEndProblem problem_{input_, options_};
};

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// d block / d tangent of its manifold.
Rows PlusJacobian(const ceres::Problem& problem, const double* block) {
  Rows plus = Rows::Identity(problem.ParameterBlockSize(block), problem.ParameterBlockSize(block));
  if (const ceres::Manifold* manifold = problem.GetManifold(block)) {
    plus.resize(manifold->AmbientSize(), manifold->TangentSize());
    manifold->PlusJacobian(block, plus.data());
  }
  return plus;
}

// The Jacobian by the tangents of all blocks that are not constant, dense, in their order.
Rows DenseJacobian(const std::vector<double*>& blocks, ceres::Problem* problem) {
  ceres::Problem::EvaluateOptions options;
  options.parameter_blocks = blocks;
  ceres::CRSMatrix sparse;
  problem->Evaluate(options, nullptr, nullptr, nullptr, &sparse);
  Rows jacobian = Rows::Zero(sparse.num_rows, sparse.num_cols);
  for (int row = 0; row < sparse.num_rows; ++row) {
    for (int k = sparse.rows[row]; k < sparse.rows[static_cast<size_t>(row) + 1]; ++k) {
      jacobian(row, sparse.cols[k]) = sparse.values[k];
    }
  }
  return jacobian;
}

TEST_F(MarginalCovariancesTest, AreBlocksOfTheInverseOfTheInformation) {
  problem_.Solve();
  problem_.PrepareCovariances();
  ceres::Problem& problem = problem_.problem();
  BackEndVariables& variables = problem_.variables();
  std::vector<double*> blocks;
  problem.GetParameterBlocks(&blocks);
  std::erase_if(blocks, [&](double* block) { return problem.IsParameterBlockConstant(block); });
  const Rows jacobian = DenseJacobian(blocks, &problem);
  const Eigen::MatrixXd expected = (jacobian.transpose() * jacobian).inverse();
  const auto column = [&](const double* block) {
    int first = 0;
    for (size_t i = 0; blocks[i] != block; ++i)
      first += problem.ParameterBlockTangentSize(blocks[i]);
    return first;
  };

  const MarginalCovariances covariances(&problem);
  ASSERT_TRUE(covariances.AreDetermined());
  for (size_t i = 0; i < sequence_.objects.size(); ++i) {
    const int first = column(variables.Landmark(i));
    Covariance9 of_landmark = expected.block<kLandmarkDof, kLandmarkDof>(first, first);
    of_landmark.topRows<3>() *= 2.0;  // Ceres' rotation tangent is half the rotation vector
    of_landmark.leftCols<3>() *= 2.0;
    EXPECT_TRUE(covariances.OfLandmark(variables.Landmark(i)).isApprox(of_landmark, 1e-6));
  }
  for (size_t i = 0; i < 2; ++i) {
    const Rows plus = PlusJacobian(problem, variables.Normal(i));
    const int normal = column(variables.Normal(i));
    const int offset = column(variables.Offset(i));
    const Eigen::MatrixXd of_normal =
        plus * expected.block<2, 2>(normal, normal) * plus.transpose();
    const Eigen::Vector3d mixed = plus * expected.block<2, 1>(normal, offset);
    Eigen::Matrix4d of_plane;
    of_plane << of_normal, mixed, mixed.transpose(), expected(offset, offset);
    EXPECT_TRUE(
        covariances.OfPlane(variables.Normal(i), variables.Offset(i)).isApprox(of_plane, 1e-6));
  }
}

TEST_F(MarginalCovariancesTest, OfAConstantPlaneAreZero) {
  problem_.Solve();
  ceres::Problem& problem = problem_.problem();
  double* normal = problem_.variables().Normal(0);
  double* offset = problem_.variables().Offset(0);
  problem.SetParameterBlockConstant(normal);
  const Eigen::Matrix4d covariance = MarginalCovariances(&problem).OfPlane(normal, offset);
  EXPECT_TRUE(covariance.topRows<3>().isZero(0.0));
  EXPECT_GT(covariance(3, 3), 0.0);
  problem.SetParameterBlockConstant(offset);
  EXPECT_TRUE(MarginalCovariances(&problem).OfPlane(normal, offset).isZero(0.0));
}

// The difference of two numbers and, with some weight, the first of them.
class TwoNumbers final : public ceres::SizedCostFunction<2, 1, 1> {
 public:
  explicit TwoNumbers(double weight) : weight_(weight) {}
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    residuals[0] = blocks[0][0] - blocks[1][0];
    residuals[1] = weight_ * blocks[0][0];
    if (jacobians == nullptr) return true;
    Eigen::Map<Eigen::Vector2d>(jacobians[0]) << 1.0, weight_;
    Eigen::Map<Eigen::Vector2d>(jacobians[1]) << -1.0, 0.0;
    return true;
  }

 private:
  double weight_;
};

// True if residuals of this weight determine two numbers.
bool AreDetermined(double weight) {
  double numbers[] = {1.0, 2.0};
  ceres::Problem problem;
  problem.AddResidualBlock(new TwoNumbers(weight), nullptr, &numbers[0], &numbers[1]);
  return MarginalCovariances(&problem).AreDetermined();
}

TEST(MarginalCovariances, AreNoneWhereResidualsDoNotDetermineAllVariables) {
  EXPECT_TRUE(AreDetermined(1.0));
  EXPECT_TRUE(AreDetermined(1e-5));
  EXPECT_FALSE(AreDetermined(1e-8));
  EXPECT_FALSE(AreDetermined(0.0));
  EXPECT_FALSE(AreDetermined(std::numeric_limits<double>::quiet_NaN()));
}

TEST(MarginalCovariances, AreNoneOfBlocksWithoutResiduals) {
  double numbers[] = {1.0, 2.0, 3.0};
  ceres::Problem problem;
  problem.AddResidualBlock(new TwoNumbers(1.0), nullptr, &numbers[0], &numbers[1]);
  const MarginalCovariances covariances(&problem);
  EXPECT_TRUE(covariances.Has(&numbers[0]));
  EXPECT_FALSE(covariances.Has(&numbers[2]));
}

}  // namespace
}  // namespace soslam

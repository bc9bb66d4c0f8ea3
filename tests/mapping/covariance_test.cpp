// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/covariance.h"

#include <ceres/sized_cost_function.h>
#include <gtest/gtest.h>

#include <limits>
#include <memory>

#include "mapping/back_end_problem.h"
#include "support/cost_function_term.h"
#include "support/cuboid_map.h"
#include "support/random.h"
#include "support/standing_scene.h"

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

// The inverse of the whole information matrix, rows and columns in the order of the blocks.
Eigen::MatrixXd DenseCovariance(const SymmetricBlocks& information) {
  Eigen::MatrixXd dense(information.NumRows(), information.NumRows());
  dense.setZero();
  for (const auto& block : information.blocks()) {
    dense.block(information.FirstRow(block.row), information.FirstRow(block.column),
                information.Size(block.row), information.Size(block.column)) =
        information.At(block.row, block.column);
  }
  return Eigen::MatrixXd(dense.selfadjointView<Eigen::Lower>()).inverse();
}

TEST_F(MarginalCovariancesTest, AreBlocksOfTheInverseOfTheInformation) {
  problem_.Solve();
  const BackEndVariables& variables = problem_.variables();
  const Terms terms = problem_.AllTerms();
  NormalEquations equations(variables.all(), terms);
  equations.Linearise(terms, Hessian::kInformation);
  const SymmetricBlocks& information = equations.hessian();
  const Eigen::MatrixXd expected = DenseCovariance(information);
  const auto row = [&](int variable) { return information.FirstRow(equations.BlockOf(variable)); };

  const MarginalCovariances covariances(variables, terms);
  ASSERT_TRUE(covariances.AreDetermined());
  for (size_t i = 0; i < sequence_.objects.size(); ++i) {
    const int first = row(variables.Landmark(i));
    EXPECT_TRUE(covariances.OfLandmark(i).isApprox(
        (expected.block<kLandmarkDof, kLandmarkDof>(first, first)), 1e-6));
  }
  for (size_t i = 0; i < 2; ++i) {
    const Eigen::MatrixXd by_step =
        ByStep(VariableKind::kNormal, variables.Values(variables.Normal(i)));
    const int normal = row(variables.Normal(i));
    const int offset = row(variables.Offset(i));
    const Eigen::MatrixXd of_normal =
        by_step * expected.block<2, 2>(normal, normal) * by_step.transpose();
    const Eigen::Vector3d mixed = by_step * expected.block<2, 1>(normal, offset);
    Eigen::Matrix4d of_plane;
    of_plane << of_normal, mixed, mixed.transpose(), expected(offset, offset);
    EXPECT_TRUE(covariances.OfPlane(i).isApprox(of_plane, 1e-6));
  }
}

TEST_F(MarginalCovariancesTest, OfAPlaneThatIsHeldAreZero) {
  problem_.Solve();
  BackEndVariables& variables = problem_.variables();
  variables.Hold(variables.Normal(0));
  const Eigen::Matrix4d held_normal =
      MarginalCovariances(variables, problem_.AllTerms()).OfPlane(0);
  EXPECT_TRUE(held_normal.topRows<3>().isZero(0.0));
  EXPECT_GT(held_normal(3, 3), 0.0);
  variables.Hold(variables.Offset(0));
  EXPECT_TRUE(MarginalCovariances(variables, problem_.AllTerms()).OfPlane(0).isZero(0.0));
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

// True if a term of this weight determines the offsets of two planes.
bool AreDetermined(double weight) {
  Sequence sequence;
  sequence.planes = {{0, Plane{}}, {1, Plane{}}};
  const BackEndInput input{sequence, {}, {}, {}, {}};
  const BackEndVariables variables(input);
  std::vector<CostFunctionTerm::Block> blocks;
  for (size_t i = 0; i < 2; ++i) {
    const int offset = variables.Offset(i);
    blocks.push_back({offset, VariableKind::kOffset, variables.Values(offset)});
  }
  const CostFunctionTerm term(std::make_unique<TwoNumbers>(weight), blocks);
  return MarginalCovariances(variables, {&term}).AreDetermined();
}

TEST(MarginalCovariances, AreNoneWhereResidualsDoNotDetermineAllVariables) {
  EXPECT_TRUE(AreDetermined(1.0));
  EXPECT_TRUE(AreDetermined(1e-5));
  EXPECT_FALSE(AreDetermined(1e-8));
  EXPECT_FALSE(AreDetermined(0.0));
  EXPECT_FALSE(AreDetermined(std::numeric_limits<double>::quiet_NaN()));
}

TEST(MarginalCovariances, AreNoneOfAProblemWithoutVariables) {
  const Sequence sequence;
  const BackEndInput input{sequence, {}, {}, {}, {}};
  EXPECT_FALSE(MarginalCovariances(BackEndVariables(input), {}).AreDetermined());
}

}  // namespace
}  // namespace soslam

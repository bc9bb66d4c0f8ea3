// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/covariance.h"

#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include <limits>
#include <utility>

#include "mapping/back_end_problem.h"
#include "mapping/choose_starts.h"
#include "support/cuboid_map.h"
#include "support/random.h"
#include "support/standing_scene.h"

namespace soslam {
namespace {

ceres::Covariance::Options CeresOptions() {
  ceres::Covariance::Options options;
  options.algorithm_type = ceres::SPARSE_QR;
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  return options;
}

// Of two floors that share a normal and six bodies on them, with poses and biases to estimate.
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

TEST_F(MarginalCovariancesTest, OfLandmarksAreThoseOfCeres) {
  problem_.Solve();
  const MarginalCovariances covariances(&problem_.problem());
  ASSERT_TRUE(covariances.AreDetermined());
  for (size_t i = 0; i < sequence_.objects.size(); ++i) {
    const double* block = problem_.variables().Landmark(i);
    ceres::Covariance by_ceres(CeresOptions());
    ASSERT_TRUE(by_ceres.Compute({std::pair(block, block)}, &problem_.problem()));
    Eigen::Matrix<double, 9, 9, Eigen::RowMajor> expected;
    by_ceres.GetCovarianceBlockInTangentSpace(block, block, expected.data());
    expected.topRows<3>() *= 2.0;  // half a rotation vector there
    expected.leftCols<3>() *= 2.0;
    EXPECT_TRUE(covariances.OfLandmark(block).isApprox(expected, 1e-6));
  }
}

TEST_F(MarginalCovariancesTest, OfPlanesAreThoseOfCeres) {
  problem_.Solve();
  const MarginalCovariances covariances(&problem_.problem());
  for (size_t i = 0; i < 2; ++i) {
    const double* normal = problem_.variables().Normal(i);
    const double* offset = problem_.variables().Offset(i);
    ceres::Covariance by_ceres(CeresOptions());
    ASSERT_TRUE(by_ceres.Compute(
        {std::pair(normal, normal), std::pair(normal, offset), std::pair(offset, offset)},
        &problem_.problem()));
    Eigen::Matrix<double, 3, 3, Eigen::RowMajor> of_normal;
    Eigen::Vector3d mixed;
    double of_offset = 0.0;
    by_ceres.GetCovarianceBlock(normal, normal, of_normal.data());
    by_ceres.GetCovarianceBlock(normal, offset, mixed.data());
    by_ceres.GetCovarianceBlock(offset, offset, &of_offset);
    Eigen::Matrix4d expected;
    expected << of_normal, mixed, mixed.transpose(), of_offset;
    EXPECT_TRUE(covariances.OfPlane(normal, offset).isApprox(expected, 1e-6));
  }
}

TEST_F(MarginalCovariancesTest, OfAPlaneThatIsHeldAreZero) {
  problem_.Solve();
  double* normal = problem_.variables().Normal(0);
  double* offset = problem_.variables().Offset(0);
  problem_.problem().SetParameterBlockConstant(normal);
  const Eigen::Matrix4d held_normal =
      MarginalCovariances(&problem_.problem()).OfPlane(normal, offset);
  EXPECT_TRUE(held_normal.topRows<3>().isZero(0.0));
  EXPECT_GT(held_normal(3, 3), 0.0);
  problem_.problem().SetParameterBlockConstant(offset);
  EXPECT_TRUE(MarginalCovariances(&problem_.problem()).OfPlane(normal, offset).isZero(0.0));
}

// The difference of two numbers and, with some weight, the first of them.
struct TwoNumbers {
  bool operator()(const double* numbers, double* residuals) const {
    residuals[0] = numbers[0] - numbers[1];
    residuals[1] = weight * numbers[0];
    return true;
  }
  double weight;
};

bool AreDetermined(double weight) {
  double numbers[2] = {0.0, 0.0};
  ceres::Problem problem;
  problem.AddResidualBlock(
      new ceres::NumericDiffCostFunction<TwoNumbers, ceres::CENTRAL, 2, 2>(new TwoNumbers{weight}),
      nullptr, numbers);
  return MarginalCovariances(&problem).AreDetermined();
}

TEST(MarginalCovariances, AreNoneWhereResidualsDoNotDetermineAllVariables) {
  EXPECT_TRUE(AreDetermined(1.0));
  EXPECT_TRUE(AreDetermined(1e-5));
  EXPECT_FALSE(AreDetermined(1e-8));
  EXPECT_FALSE(AreDetermined(0.0));
  EXPECT_FALSE(AreDetermined(std::numeric_limits<double>::quiet_NaN()));
}

TEST(MarginalCovariances, AreNoneOfAProblemWithoutVariables) {
  ceres::Problem problem;
  EXPECT_FALSE(MarginalCovariances(&problem).AreDetermined());
}

}  // namespace
}  // namespace soslam

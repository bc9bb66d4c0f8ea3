// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/mapping/linear_solver.h"

#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <vector>

#include "support/random.h"

namespace soslam {
namespace {

// The difference of two values of six numbers each.
class DifferenceResidual final : public ceres::SizedCostFunction<6, 6, 6> {
 public:
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    using Square = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
    for (int i = 0; i < 6; ++i) residuals[i] = blocks[1][i] - blocks[0][i];
    for (int block = 0; jacobians != nullptr && block < 2; ++block) {
      if (jacobians[block] == nullptr) continue;
      Eigen::Map<Square> jacobian(jacobians[block]);
      jacobian = (block == 0 ? -1.0 : 1.0) * Square::Identity();
    }
    return true;
  }
};

// Frames one after the other, and things that frames see which are at most `width` frames away;
// from random values, the minimum has the cost zero. The solver that is chosen, after solving.
ceres::LinearSolverType ChosenFor(int frames, int things, int width) {
  std::vector<std::array<double, 6>> values(static_cast<size_t>(frames + things));
  for (auto& value : values) {
    for (double& number : value) number = RandomUniform(-1.0, 1.0);
  }
  ceres::Problem problem;
  for (int i = 0; i < frames; ++i) {
    if (i > 0) {
      problem.AddResidualBlock(new DifferenceResidual, nullptr, values[i - 1].data(),
                               values[i].data());
    }
    for (int k = 0; k < things; ++k) {
      if (std::abs(k * frames / things - i) > width) continue;
      problem.AddResidualBlock(new DifferenceResidual, nullptr, values[i].data(),
                               values[frames + k].data());
    }
  }
  problem.SetParameterBlockConstant(values[0].data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.initial_trust_region_radius = 1e12;
  options.max_num_iterations = 2;
  options.logging_type = ceres::SILENT;
  ChooseLinearSolver(problem, &options);
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  EXPECT_NEAR(summary.final_cost, 0.0, 1e-12);
  return options.linear_solver_type;
}

TEST(LinearSolverTest, FewThingsThatAllFramesSeeAreDense) {
  EXPECT_EQ(ChosenFor(200, 40, 200), ceres::DENSE_SCHUR);
  EXPECT_EQ(ChosenFor(20, 10, 20), ceres::DENSE_SCHUR);
}

TEST(LinearSolverTest, LongWalksAreSparse) {
  EXPECT_EQ(ChosenFor(500, 500, 5), ceres::SPARSE_NORMAL_CHOLESKY);
  EXPECT_EQ(ChosenFor(2000, 10, 2000), ceres::SPARSE_NORMAL_CHOLESKY);
}

// There is nothing to decompose once it is eliminated.
TEST(LinearSolverTest, OneBlockIsSparse) {
  EXPECT_EQ(ChosenFor(2, 0, 0), ceres::SPARSE_NORMAL_CHOLESKY);
}

}  // namespace
}  // namespace soslam

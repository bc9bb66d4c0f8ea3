// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/mapping/normal_equations.h"

#include <ceres/crs_matrix.h>
#include <ceres/manifold.h>

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <utility>

#include "soslam/constraints/tangency.h"

namespace soslam {

std::vector<double*> VariableBlocks(const ceres::Problem& problem) {
  std::vector<double*> blocks;
  problem.GetParameterBlocks(&blocks);
  std::erase_if(blocks, [&](double* block) { return problem.IsParameterBlockConstant(block); });
  return blocks;
}

NormalEquations MakeNormalEquations(const std::vector<double*>& blocks, CurvatureRows curvature,
                                    ceres::Problem* problem) {
  using Jacobian = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  constexpr size_t kTogether = 2'000;  // residual blocks whose Jacobian is in memory
  NormalEquations sum;
  std::vector<ceres::ResidualBlockId> residuals;
  problem->GetResidualBlocks(&residuals);
  for (size_t begin = 0; begin < residuals.size(); begin += kTogether) {
    const size_t end = std::min(residuals.size(), begin + kTogether);
    ceres::Problem::EvaluateOptions options;
    options.parameter_blocks = blocks;
    options.residual_blocks.assign(residuals.begin() + begin, residuals.begin() + end);
    std::vector<double> gradient;
    ceres::CRSMatrix rows;
    if (!problem->Evaluate(options, nullptr, nullptr, &gradient, &rows)) return {};
    int row = 0;  // the first one after the present block
    for (const ceres::ResidualBlockId residual : options.residual_blocks) {
      const ceres::CostFunction* cost = problem->GetCostFunctionForResidualBlock(residual);
      row += cost->num_residuals();
      if (curvature == CurvatureRows::kWith || !dynamic_cast<const TangencyResidual*>(cost)) {
        continue;
      }
      std::fill(rows.values.begin() + rows.rows[row - TangencyResidual::kCurvatureRows],
                rows.values.begin() + rows.rows[row], 0.0);
    }
    const Eigen::Map<const Jacobian> jacobian(
        rows.num_rows, rows.num_cols, static_cast<int>(rows.values.size()), rows.rows.data(),
        rows.cols.data(), rows.values.data());
    const Eigen::SparseMatrix<double> product = jacobian.transpose() * jacobian;
    const Eigen::Map<const Eigen::VectorXd> of_cost(gradient.data(), rows.num_cols);
    if (begin == 0) {
      sum = {product, of_cost};
    } else {
      sum.matrix += product;
      sum.gradient += of_cost;
    }
  }
  return sum;
}

// With J and g of what is variable, B and b of the blocks:
// information = B^T B - B^T J (J^T J)^-1 J^T B, gradient = b - B^T J (J^T J)^-1 g.
ScoreTest::ScoreTest(std::set<double*> constant_blocks, ceres::Problem* problem)
    : blocks_(std::move(constant_blocks)), problem_(problem) {
  constexpr double kDamping = 1e-8;  // what no residual determines stays
  std::vector<double*> all = VariableBlocks(*problem);
  all.insert(all.end(), blocks_.begin(), blocks_.end());
  Eigen::Index own = 0;
  for (double* block : blocks_) {
    problem->SetParameterBlockVariable(block);
    own += problem->ParameterBlockTangentSize(block);
  }
  auto [normal, gradient] = MakeNormalEquations(all, CurvatureRows::kWith, problem);
  for (double* block : blocks_) problem->SetParameterBlockConstant(block);
  for (Eigen::Index i = 0; i < normal.rows(); ++i) {
    normal.coeffRef(i, i) += kDamping * (1.0 + normal.coeff(i, i));
  }
  const Eigen::Index others = normal.rows() - own;
  information_ = normal.bottomRightCorner(own, own);
  const Eigen::MatrixXd mixed = normal.topRightCorner(others, own);
  normal.conservativeResize(others, others);
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(normal);
  const Eigen::MatrixXd eliminated = factor.solve(mixed);
  information_ -= mixed.transpose() * eliminated;
  gradient_ = gradient.tail(own) - eliminated.transpose() * gradient.head(others);
}

double ScoreTest::Step(const std::set<double*>& blocks) const {
  std::vector<Eigen::Index> columns;
  Eigen::Index first = 0;
  for (double* block : blocks_) {
    const int size = problem_->ParameterBlockTangentSize(block);
    for (int i = 0; i < size && blocks.contains(block); ++i) columns.push_back(first + i);
    first += size;
  }
  const Eigen::VectorXd gradient = gradient_(columns);
  const Eigen::MatrixXd information = information_(columns, columns);
  const Eigen::VectorXd step = -information.ldlt().solve(gradient);
  first = 0;
  for (double* block : blocks) {
    const Eigen::VectorXd from =
        Eigen::Map<Eigen::VectorXd>(block, problem_->ParameterBlockSize(block));
    if (const ceres::Manifold* manifold = problem_->GetManifold(block)) {
      manifold->Plus(from.data(), &step[first], block);
    } else {
      Eigen::Map<Eigen::VectorXd>(block, from.size()) += step.segment(first, from.size());
    }
    first += problem_->ParameterBlockTangentSize(block);
  }
  return -0.5 * gradient.dot(step);
}

}  // namespace soslam

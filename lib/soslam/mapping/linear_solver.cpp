// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/mapping/linear_solver.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <map>
#include <memory>
#include <numeric>
#include <vector>

#include "soslam/mapping/normal_equations.h"

namespace soslam {
namespace {

using Graph = Eigen::SparseMatrix<double>;

// Which blocks have common residuals, positive definite.
Graph ConnectBlocks(const std::vector<double*>& blocks, const ceres::Problem& problem) {
  std::map<const double*, int> index_of;
  for (size_t i = 0; i < blocks.size(); ++i) index_of[blocks[i]] = static_cast<int>(i);
  std::vector<ceres::ResidualBlockId> residuals;
  problem.GetResidualBlocks(&residuals);
  std::vector<Eigen::Triplet<double>> pairs;
  std::vector<double*> of_residual;
  for (const ceres::ResidualBlockId residual : residuals) {
    problem.GetParameterBlocksForResidualBlock(residual, &of_residual);
    for (const double* first : of_residual) {
      const auto column = index_of.find(first);
      if (column == index_of.end()) continue;
      for (const double* second : of_residual) {
        const auto row = index_of.find(second);
        if (row != index_of.end()) pairs.emplace_back(row->second, column->second, 1.0);
      }
    }
  }
  const auto size = static_cast<int>(blocks.size());
  for (int i = 0; i < size; ++i) pairs.emplace_back(i, i, 1.0);
  Graph graph(size, size);
  graph.setFromTriplets(pairs.begin(), pairs.end());
  return graph;
}

// The unknowns of the rows in each column.
Eigen::VectorXd CountRows(const Graph& graph, const Eigen::VectorXd& sizes) {
  Eigen::VectorXd count = Eigen::VectorXd::Zero(graph.cols());
  for (Eigen::Index i = 0; i < graph.cols(); ++i) {
    for (Graph::InnerIterator row(graph, i); row; ++row) count[i] += sizes[row.row()];
  }
  return count;
}

// Multiplications of a dense decomposition in the time of one of a sparse decomposition, which
// Eigen does not vectorise.
constexpr double kVectorised = 5.0;

}  // namespace

void ChooseLinearSolver(const ceres::Problem& problem, ceres::Solver::Options* options) {
  const std::vector<double*> blocks = VariableBlocks(problem);
  const Graph graph = ConnectBlocks(blocks, problem);
  Eigen::VectorXd sizes(graph.cols());  // unknowns of each block
  for (Eigen::Index i = 0; i < sizes.size(); ++i) {
    sizes[i] = problem.ParameterBlockTangentSize(blocks[static_cast<size_t>(i)]);
  }
  const Eigen::SimplicialLLT<Graph> factor(graph);
  const Eigen::VectorXd rows =
      CountRows(factor.matrixL().nestedExpression(), factor.permutationP() * sizes);
  const double sparse = (factor.permutationP() * sizes).dot(rows.cwiseAbs2());
  // Blocks that are not connected, those with fewest neighbours first.
  std::vector<Eigen::Index> order(blocks.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](Eigen::Index i) { return graph.col(i).nonZeros(); });
  std::vector<bool> is_neighbour(blocks.size(), false);
  const Eigen::VectorXd neighbours = CountRows(graph, sizes);
  auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  double rest = 0.0, dense = 0.0;
  for (const Eigen::Index i : order) {
    ordering->AddElementToGroup(blocks[i], is_neighbour[i] ? 1 : 0);
    if (is_neighbour[i]) {
      rest += sizes[i];
      continue;
    }
    dense += sizes[i] * neighbours[i] * neighbours[i];
    for (Graph::InnerIterator other(graph, i); other; ++other) is_neighbour[other.row()] = true;
  }
  dense += rest * rest * rest / 3.0;
  if (rest == 0.0 || kVectorised * sparse <= dense) return;
  options->linear_solver_type = ceres::DENSE_SCHUR;
  options->dense_linear_algebra_library_type = ceres::EIGEN;
  options->linear_solver_ordering = std::move(ordering);
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/block_cholesky.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "support/random.h"

namespace soslam {
namespace {

using Couplings = std::vector<std::array<int, 2>>;

// Random matrix J^T J with one residual block per coupling and one per variable.
SymmetricBlocks RandomMatrix(const std::vector<int>& sizes, const Couplings& couplings) {
  SymmetricBlocks matrix(sizes, couplings);
  const auto random = [](int rows, int columns) {
    return Eigen::MatrixXd::NullaryExpr(rows, columns, [] { return RandomUniform(-1, 1); }).eval();
  };
  for (int i = 0; i < matrix.NumVariables(); ++i) {
    const Eigen::MatrixXd jacobian = random(matrix.Size(i), matrix.Size(i));
    matrix.At(i, i) += jacobian.transpose() * jacobian;
  }
  for (const auto& [row, column] : couplings) {
    const Eigen::MatrixXd by_row = random(3, matrix.Size(row));
    const Eigen::MatrixXd by_column = random(3, matrix.Size(column));
    matrix.At(row, row) += by_row.transpose() * by_row;
    matrix.At(column, column) += by_column.transpose() * by_column;
    matrix.At(row, column) += by_row.transpose() * by_column;
  }
  return matrix;
}

Eigen::MatrixXd Dense(const SymmetricBlocks& matrix) {
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(matrix.NumRows(), matrix.NumRows());
  for (const auto& block : matrix.blocks()) {
    const Eigen::MatrixXd values = matrix.At(block.row, block.column);
    dense.block(matrix.FirstRow(block.row), matrix.FirstRow(block.column), values.rows(),
                values.cols()) = values;
    dense.block(matrix.FirstRow(block.column), matrix.FirstRow(block.row), values.cols(),
                values.rows()) = values.transpose();
  }
  return dense;
}

void ExpectAsDense(const SymmetricBlocks& matrix) {
  const Eigen::VectorXd diagonal =
      Eigen::VectorXd::NullaryExpr(matrix.NumRows(), [] { return RandomUniform(0, 0.1); });
  const Eigen::VectorXd right_side =
      Eigen::VectorXd::NullaryExpr(matrix.NumRows(), [] { return RandomUniform(-1, 1); });
  Eigen::MatrixXd dense = Dense(matrix);
  dense.diagonal() += diagonal;
  BlockCholesky cholesky(matrix);
  ASSERT_TRUE(cholesky.Factor(matrix, diagonal));
  EXPECT_LT((dense * cholesky.Solve(right_side) - right_side).norm(), 1e-9 * right_side.norm());

  const Eigen::MatrixXd expected = dense.inverse();
  const SymmetricBlocks inverse = cholesky.InverseOnPattern(matrix);
  for (const auto& block : matrix.blocks()) {
    const Eigen::MatrixXd of_block =
        expected.block(matrix.FirstRow(block.row), matrix.FirstRow(block.column),
                       matrix.Size(block.row), matrix.Size(block.column));
    EXPECT_LT((inverse.At(block.row, block.column) - of_block).norm(), 1e-9 * expected.norm());
  }
}

TEST(BlockCholesky, AgreesWithDenseMatrices) {
  for (int trial = 0; trial < 50; ++trial) {
    const auto variables = static_cast<int>(TestRandom()() % 30) + 1;
    std::vector<int> sizes;
    for (int i = 0; i < variables; ++i) sizes.push_back(static_cast<int>(TestRandom()() % 9) + 1);
    Couplings couplings;
    for (int i = 0; i < 2 * variables; ++i) {
      const auto one = static_cast<int>(TestRandom()() % static_cast<unsigned>(variables));
      const auto other = static_cast<int>(TestRandom()() % static_cast<unsigned>(variables));
      if (one != other) couplings.push_back({std::max(one, other), std::min(one, other)});
    }
    ExpectAsDense(RandomMatrix(sizes, couplings));
  }
}

// Poses in a chain, each landmark seen by the next ones, one plane under all.
TEST(BlockCholesky, AgreesWithDenseMatricesOfADrive) {
  constexpr int kFrames = 60, kViews = 8;
  std::vector<int> sizes(kFrames, 6);
  sizes.insert(sizes.end(), kFrames - kViews, 9);
  const auto plane = static_cast<int>(sizes.size());
  sizes.push_back(2);
  Couplings couplings;
  for (int i = 1; i < kFrames; ++i) couplings.push_back({i, i - 1});
  for (int i = 0; i < kFrames - kViews; ++i) {
    for (int view = 0; view < kViews; ++view) couplings.push_back({kFrames + i, i + view});
    couplings.push_back({plane, kFrames + i});
  }
  ExpectAsDense(RandomMatrix(sizes, couplings));
}

TEST(BlockCholesky, RefusesWhatIsNotPositiveDefinite) {
  SymmetricBlocks matrix({1, 1}, {{1, 0}});
  matrix.At(0, 0)(0) = matrix.At(1, 1)(0) = 1.0;
  matrix.At(1, 0)(0) = 2.0;
  BlockCholesky cholesky(matrix);
  EXPECT_FALSE(cholesky.Factor(matrix, Eigen::Vector2d::Zero()));
  EXPECT_TRUE(cholesky.Factor(matrix, Eigen::Vector2d::Constant(2.0)));
}

// The second pivot of [[1, c], [c, 1]] is 1 - c^2 of its diagonal element, in any units.
TEST(BlockCholesky, TellsHowIndependentVariablesAre) {
  for (const double unit : {1.0, 1e-6}) {
    SymmetricBlocks matrix({1, 1}, {{1, 0}});
    matrix.At(0, 0)(0) = 1.0;
    matrix.At(1, 0)(0) = 0.6 * unit;
    matrix.At(1, 1)(0) = unit * unit;
    BlockCholesky cholesky(matrix);
    ASSERT_TRUE(cholesky.Factor(matrix, Eigen::Vector2d::Zero()));
    EXPECT_NEAR(cholesky.LeastIndependentShare(matrix), 0.64, 1e-12);
  }
}

}  // namespace
}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapping/elimination_tree.h"
#include "mapping/symmetric_blocks.h"

namespace soslam {

// Cholesky factor of a sparse symmetric matrix of blocks, by the multifrontal method (Duff and
// Reid, 1983): variables are eliminated in an order that keeps the factor sparse, those with nearly
// the same neighbours together, each group in one dense matrix over itself and its neighbours (its
// front). Order and fronts follow from the pattern alone and are found once. All sums are in the
// same order in every run.
class BlockCholesky {
 public:
  explicit BlockCholesky(const SymmetricBlocks& pattern);

  // Factors the matrix, which has the pattern, plus a diagonal. Returns false if the sum is not
  // positive definite.
  bool Factor(const SymmetricBlocks& matrix, const Eigen::VectorXd& diagonal);

  // Smallest ratio of a pivot to its diagonal element of the matrix: 1 for a diagonal matrix, 0 for
  // a singular one. The matrix must be the one that was factored, with a diagonal of zero.
  double LeastIndependentShare(const SymmetricBlocks& matrix) const;

  // x of (matrix) x = right_side.
  Eigen::VectorXd Solve(const Eigen::VectorXd& right_side) const;

  // Those blocks of the inverse that the pattern has: the time is that of Factor, not that of
  // solving for every column.
  SymmetricBlocks InverseOnPattern(const SymmetricBlocks& pattern) const;

 private:
  // A stored block of the matrix and its place in a front.
  struct Entry {
    size_t begin;
    int rows, columns;  // as stored
    int front_row, front_column;
    bool is_transposed;
  };
  // Consecutive rows of a front, and where they are in that of its parent.
  struct Run {
    int begin, parent_begin, length;
  };
  struct Front {
    int parent = -1;
    int first = 0;              // of its pivots, in the order of elimination
    int pivots = 0;             // rows that are eliminated
    int size = 0;               // these and their neighbours
    size_t factor = 0;          // where its columns of the factor begin: size x pivots
    size_t update = 0;          // where what it leaves to its parent begins, on the stack
    std::vector<int> rows;      // neighbours, in the order of elimination
    std::vector<int> children;  // in the order of elimination
    std::vector<Run> runs;      // of the neighbours, counted from the first of them
    std::vector<Entry> entries;
  };

  // Where variables are in the order of elimination.
  struct Places {
    std::vector<int> first_row;  // by variable
    std::vector<size_t> front;   // that eliminates it, by variable
  };

  Places OrderRows(const SymmetricBlocks& pattern, const std::vector<EliminationGroup>& groups);
  void MakeFronts(const SymmetricBlocks& pattern, const std::vector<EliminationGroup>& groups,
                  const Places& places);
  void FindRuns();
  void FindEntries(const SymmetricBlocks& pattern, const Places& places);
  static int RowInFront(const Front& front, int row);

  void Assemble(const SymmetricBlocks& matrix, const Eigen::VectorXd& diagonal, const Front& front,
                Eigen::Ref<Eigen::MatrixXd> dense) const;
  Eigen::Map<const Eigen::MatrixXd> FactorOf(const Front& front) const {
    return {&factor_[front.factor], front.size, front.pivots};
  }

  std::vector<Front> fronts_;       // children before parents
  std::vector<int> original_rows_;  // by row in the order of elimination
  std::vector<double> factor_;
  std::vector<double> stack_;     // what fronts leave to their parents, until they take it
  Eigen::VectorXd front_values_;  // of the front at work
};

}  // namespace soslam

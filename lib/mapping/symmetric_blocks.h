// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace soslam {

// A symmetric matrix with a dense block for each coupled pair of variables: the normal equations of
// a sparse problem. Only blocks on and below the diagonal are stored, column-major; diagonal blocks
// as a whole, of which the lower triangle counts.
class SymmetricBlocks {
 public:
  struct Block {
    int row, column;  // row >= column
    size_t begin;     // of its values
  };

  // `sizes` of the diagonal blocks; `couplings` are the (row, column), row > column, that may be
  // other than zero besides; in any order, repeated or not. All values are zero.
  SymmetricBlocks(std::vector<int> sizes, std::vector<std::array<int, 2>> couplings);

  int NumVariables() const { return static_cast<int>(sizes_.size()); }
  int NumRows() const { return first_rows_.back(); }
  int Size(int variable) const { return sizes_[static_cast<size_t>(variable)]; }
  int FirstRow(int variable) const { return first_rows_[static_cast<size_t>(variable)]; }

  // Column by column, downwards.
  const std::vector<Block>& blocks() const { return blocks_; }
  // Where the values of a stored block begin.
  size_t Begin(int row, int column) const;
  Eigen::Map<Eigen::MatrixXd> Values(size_t begin, int rows, int columns) {
    return {&values_[begin], rows, columns};
  }
  Eigen::Map<const Eigen::MatrixXd> Values(size_t begin, int rows, int columns) const {
    return {&values_[begin], rows, columns};
  }
  double* Data(size_t begin) { return &values_[begin]; }
  Eigen::Map<Eigen::MatrixXd> At(int row, int column) {
    return Values(Begin(row, column), Size(row), Size(column));
  }
  Eigen::Map<const Eigen::MatrixXd> At(int row, int column) const {
    return Values(Begin(row, column), Size(row), Size(column));
  }

  void SetZero() { std::fill(values_.begin(), values_.end(), 0.0); }
  Eigen::VectorXd Diagonal() const;

 private:
  std::vector<int> sizes_;
  std::vector<int> first_rows_;  // one more than variables
  std::vector<Block> blocks_;
  std::vector<size_t> first_blocks_;  // of each column, one more than variables
  std::vector<double> values_;
};

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/block_cholesky.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace soslam {
namespace {

// below := below L^-T. What Eigen does before and after takes longer than few columns.
void DivideByRoot(const Eigen::Ref<const Eigen::MatrixXd>& root,
                  Eigen::Ref<Eigen::MatrixXd>* below) {
  constexpr Eigen::Index kFew = 12;
  if (root.cols() > kFew) {
    root.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(*below);
    return;
  }
  for (Eigen::Index j = 0; j < root.cols(); ++j) {
    for (Eigen::Index k = 0; k < j; ++k) below->col(j) -= root(j, k) * below->col(k);
    below->col(j) /= root(j, j);
  }
}

}  // namespace

BlockCholesky::BlockCholesky(const SymmetricBlocks& pattern) {
  const std::vector<EliminationGroup> groups = EliminationTree(pattern);
  const Places places = OrderRows(pattern, groups);
  MakeFronts(pattern, groups, places);
  FindRuns();
  FindEntries(pattern, places);
}

BlockCholesky::Places BlockCholesky::OrderRows(const SymmetricBlocks& pattern,
                                               const std::vector<EliminationGroup>& groups) {
  const auto variables = static_cast<size_t>(pattern.NumVariables());
  Places places{std::vector<int>(variables), std::vector<size_t>(variables)};
  for (size_t g = 0; g < groups.size(); ++g) {
    for (const int variable : groups[g].pivots) {
      places.front[static_cast<size_t>(variable)] = g;
      places.first_row[static_cast<size_t>(variable)] = static_cast<int>(original_rows_.size());
      for (int i = 0; i < pattern.Size(variable); ++i) {
        original_rows_.push_back(pattern.FirstRow(variable) + i);
      }
    }
  }
  return places;
}

void BlockCholesky::MakeFronts(const SymmetricBlocks& pattern,
                               const std::vector<EliminationGroup>& groups, const Places& places) {
  const auto first_row = [&](int variable) {
    return places.first_row[static_cast<size_t>(variable)];
  };
  size_t factor_size = 0, stack_limit = 0, largest = 0;
  size_t stack_size = 0;
  fronts_.resize(groups.size());
  for (size_t g = 0; g < groups.size(); ++g) {
    Front& front = fronts_[g];
    front.parent = groups[g].parent;
    front.first = first_row(groups[g].pivots.front());
    for (const int variable : groups[g].pivots) front.pivots += pattern.Size(variable);
    for (const int variable : groups[g].neighbours) {
      for (int i = 0; i < pattern.Size(variable); ++i) {
        front.rows.push_back(first_row(variable) + i);
      }
    }
    front.size = front.pivots + static_cast<int>(front.rows.size());
    front.factor = factor_size;
    factor_size += static_cast<size_t>(front.size * front.pivots);
    // What its children left begins where it leaves its own.
    front.update = front.children.empty()
                       ? stack_size
                       : fronts_[static_cast<size_t>(front.children.front())].update;
    stack_size = front.update + front.rows.size() * front.rows.size();
    stack_limit = std::max(stack_limit, stack_size);
    largest = std::max(largest, static_cast<size_t>(front.size));
    if (front.parent >= 0) {
      fronts_[static_cast<size_t>(front.parent)].children.push_back(static_cast<int>(g));
    }
  }
  factor_.resize(factor_size);
  stack_.resize(stack_limit);
  front_values_.resize(static_cast<Eigen::Index>(largest * largest));
}

int BlockCholesky::RowInFront(const Front& front, int row) {
  if (row < front.first + front.pivots) return row - front.first;
  const auto found = std::ranges::lower_bound(front.rows, row);
  return front.pivots + static_cast<int>(found - front.rows.begin());
}

void BlockCholesky::FindRuns() {
  for (Front& front : fronts_) {
    if (front.parent < 0) continue;
    const Front& parent = fronts_[static_cast<size_t>(front.parent)];
    for (size_t i = 0; i < front.rows.size(); ++i) {
      const int in_parent = RowInFront(parent, front.rows[i]);
      if (!front.runs.empty() &&
          front.runs.back().parent_begin + front.runs.back().length == in_parent) {
        ++front.runs.back().length;
      } else {
        front.runs.push_back({static_cast<int>(i), in_parent, 1});
      }
    }
  }
}

void BlockCholesky::FindEntries(const SymmetricBlocks& pattern, const Places& places) {
  for (const auto& block : pattern.blocks()) {
    const int row = places.first_row[static_cast<size_t>(block.row)];
    const int column = places.first_row[static_cast<size_t>(block.column)];
    const int eliminated_first = row < column ? block.row : block.column;
    Front& front = fronts_[places.front[static_cast<size_t>(eliminated_first)]];
    front.entries.push_back({block.begin, pattern.Size(block.row), pattern.Size(block.column),
                             RowInFront(front, std::max(row, column)),
                             RowInFront(front, std::min(row, column)), row < column});
  }
}

// Below the diagonal, as everywhere here, and on it.
void BlockCholesky::Assemble(const SymmetricBlocks& matrix, const Eigen::VectorXd& diagonal,
                             const Front& front, Eigen::Ref<Eigen::MatrixXd> dense) const {
  for (int j = 0; j < front.size; ++j) dense.col(j).tail(front.size - j).setZero();
  for (const Entry& entry : front.entries) {
    const auto block = matrix.Values(entry.begin, entry.rows, entry.columns);
    if (entry.is_transposed) {
      dense.block(entry.front_row, entry.front_column, entry.columns, entry.rows) =
          block.transpose();
    } else {
      dense.block(entry.front_row, entry.front_column, entry.rows, entry.columns) = block;
    }
  }
  for (int i = 0; i < front.pivots; ++i) {
    dense(i, i) += diagonal[original_rows_[static_cast<size_t>(front.first + i)]];
  }
  for (const int index : front.children) {
    const Front& child = fronts_[static_cast<size_t>(index)];
    const auto rows = static_cast<Eigen::Index>(child.rows.size());
    const Eigen::Map<const Eigen::MatrixXd> update(&stack_[child.update], rows, rows);
    for (size_t j = 0; j < child.runs.size(); ++j) {
      const Run& columns = child.runs[j];
      for (int k = 0; k < columns.length; ++k) {
        const int column = columns.begin + k;
        const int in_parent = columns.parent_begin + k;
        dense.col(in_parent).segment(in_parent, columns.length - k) +=
            update.col(column).segment(column, columns.length - k);
        for (size_t i = j + 1; i < child.runs.size(); ++i) {
          const Run& run = child.runs[i];
          dense.col(in_parent).segment(run.parent_begin, run.length) +=
              update.col(column).segment(run.begin, run.length);
        }
      }
    }
  }
}

bool BlockCholesky::Factor(const SymmetricBlocks& matrix, const Eigen::VectorXd& diagonal) {
  for (const Front& front : fronts_) {
    Eigen::Map<Eigen::MatrixXd> dense(front_values_.data(), front.size, front.size);
    Assemble(matrix, diagonal, front, dense);
    const auto neighbours = static_cast<Eigen::Index>(front.rows.size());
    Eigen::Ref<Eigen::MatrixXd> corner = dense.topLeftCorner(front.pivots, front.pivots);
    Eigen::Map<Eigen::MatrixXd> columns(&factor_[front.factor], front.size, front.pivots);
    const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> root(corner);
    if (root.info() != Eigen::Success) return false;
    columns.topRows(front.pivots) = corner;
    if (neighbours == 0) continue;
    Eigen::Ref<Eigen::MatrixXd> below = columns.bottomRows(neighbours);
    below = dense.bottomLeftCorner(neighbours, front.pivots);
    DivideByRoot(corner, &below);
    Eigen::Map<Eigen::MatrixXd> update(&stack_[front.update], neighbours, neighbours);
    update = dense.bottomRightCorner(neighbours, neighbours);
    update.selfadjointView<Eigen::Lower>().rankUpdate(below, -1.0);
  }
  return true;
}

double BlockCholesky::LeastIndependentShare(const SymmetricBlocks& matrix) const {
  const Eigen::VectorXd elements = matrix.Diagonal();
  double least = 1.0;
  for (const Front& front : fronts_) {
    const auto root = FactorOf(front).topRows(front.pivots).diagonal();
    for (int i = 0; i < front.pivots; ++i) {
      const double element = elements[original_rows_[static_cast<size_t>(front.first + i)]];
      least = std::min(least, root[i] * root[i] / element);
    }
  }
  return least;
}

Eigen::VectorXd BlockCholesky::Solve(const Eigen::VectorXd& right_side) const {
  Eigen::VectorXd x(right_side.size());
  for (Eigen::Index i = 0; i < x.size(); ++i)
    x[i] = right_side[original_rows_[static_cast<size_t>(i)]];
  for (const Front& front : fronts_) {
    for (int j = 0; j < front.pivots; ++j) {
      const double* column = &factor_[front.factor + static_cast<size_t>(j * front.size)];
      const double value = x[front.first + j] /= column[j];
      for (int i = j + 1; i < front.pivots; ++i) x[front.first + i] -= value * column[i];
      column += front.pivots;
      for (size_t i = 0; i < front.rows.size(); ++i) x[front.rows[i]] -= value * column[i];
    }
  }
  for (auto front = fronts_.rbegin(); front != fronts_.rend(); ++front) {
    for (int j = front->pivots - 1; j >= 0; --j) {
      const double* column = &factor_[front->factor + static_cast<size_t>(j * front->size)];
      double value = x[front->first + j];
      for (int i = j + 1; i < front->pivots; ++i) value -= column[i] * x[front->first + i];
      const double* below = column + front->pivots;
      for (size_t i = 0; i < front->rows.size(); ++i) value -= below[i] * x[front->rows[i]];
      x[front->first + j] = value / column[j];
    }
  }
  Eigen::VectorXd solution(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i)
    solution[original_rows_[static_cast<size_t>(i)]] = x[i];
  return solution;
}

// From the roots down: with the inverse S over a front's neighbours known from its parent, and the
// factor's columns [L; B], the rest is S_np = -S B L^-1 and S_pp = (L L^T)^-1 - (B L^-1)^T S_np.
SymmetricBlocks BlockCholesky::InverseOnPattern(const SymmetricBlocks& pattern) const {
  SymmetricBlocks inverse = pattern;
  std::vector<Eigen::MatrixXd> inverses(fronts_.size());  // while children need them
  for (size_t f = fronts_.size(); f-- > 0;) {
    const Front& front = fronts_[f];
    const auto neighbours = static_cast<Eigen::Index>(front.rows.size());
    Eigen::MatrixXd& whole = inverses[f];
    whole.resize(front.size, front.size);
    const auto columns = FactorOf(front);
    const auto root = columns.topRows(front.pivots).triangularView<Eigen::Lower>();
    auto of_pivots = whole.topLeftCorner(front.pivots, front.pivots);
    of_pivots.setIdentity();
    root.solveInPlace(of_pivots);
    of_pivots = (of_pivots.transpose() * of_pivots).eval();
    if (neighbours > 0) {
      const Eigen::MatrixXd& of_parent = inverses[static_cast<size_t>(front.parent)];
      auto of_neighbours = whole.bottomRightCorner(neighbours, neighbours);
      for (const Run& rows : front.runs) {
        for (const Run& cols : front.runs) {
          of_neighbours.block(rows.begin, cols.begin, rows.length, cols.length) =
              of_parent.block(rows.parent_begin, cols.parent_begin, rows.length, cols.length);
        }
      }
      Eigen::MatrixXd elimination = columns.bottomRows(neighbours);
      root.solveInPlace<Eigen::OnTheRight>(elimination);
      const Eigen::MatrixXd mixed = -of_neighbours * elimination;
      of_pivots -= elimination.transpose() * mixed;
      whole.bottomLeftCorner(neighbours, front.pivots) = mixed;
      whole.topRightCorner(front.pivots, neighbours) = mixed.transpose();
    }
    for (const Entry& entry : front.entries) {
      auto block = inverse.Values(entry.begin, entry.rows, entry.columns);
      if (entry.is_transposed) {
        block = whole.block(entry.front_column, entry.front_row, entry.rows, entry.columns);
      } else {
        block = whole.block(entry.front_row, entry.front_column, entry.rows, entry.columns);
      }
    }
    // Fronts come after their parents: the first child is the last to need the parent's.
    if (front.parent >= 0 &&
        fronts_[static_cast<size_t>(front.parent)].children.front() == static_cast<int>(f)) {
      inverses[static_cast<size_t>(front.parent)].resize(0, 0);
    }
    if (front.children.empty()) whole.resize(0, 0);
  }
  return inverse;
}

}  // namespace soslam

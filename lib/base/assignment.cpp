// SPDX-License-Identifier: BSD-3-Clause
#include "base/assignment.h"

#include <limits>

namespace soslam {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A matching that is optimal for the rows added so far. Behind the given columns there is one dummy
// column per row, which stands for no column, so that a row can always be added.
class OptimalMatching {
 public:
  OptimalMatching(const Eigen::MatrixXd& costs, const Eigen::VectorXd& unassigned_costs)
      : costs_(costs),
        unassigned_costs_(unassigned_costs),
        columns_(static_cast<int>(costs.cols() + unassigned_costs.size())),
        row_potentials_(Eigen::VectorXd::Zero(unassigned_costs.size())),
        column_potentials_(Eigen::VectorXd::Zero(columns_)),
        row_of_column_(static_cast<size_t>(columns_), kUnassigned) {}

  int RowOf(int column) const { return row_of_column_[column]; }

  // Adds a row along the shortest path (by reduced costs) from it to a free column.
  void Add(int row) {
    Eigen::VectorXd distances = Eigen::VectorXd::Constant(columns_, kInfinity);
    std::vector<int> before(static_cast<size_t>(columns_), kUnassigned);  // predecessor on the path
    std::vector<bool> reached(static_cast<size_t>(columns_), false);
    std::vector<int> order;  // columns as they are reached
    int from_row = row;
    int from_column = kUnassigned;
    double length = 0.0;
    for (;;) {
      int nearest = kUnassigned;
      for (int column = 0; column < columns_; ++column) {
        if (reached[column]) continue;
        const double distance = length + Cost(from_row, column) - row_potentials_[from_row] -
                                column_potentials_[column];
        if (distance < distances[column]) {
          distances[column] = distance;
          before[column] = from_column;
        }
        if (nearest == kUnassigned || distances[column] < distances[nearest]) nearest = column;
      }
      length = distances[nearest];
      reached[nearest] = true;
      from_column = nearest;
      from_row = RowOf(nearest);
      if (from_row == kUnassigned) break;
      order.push_back(nearest);
    }
    UpdatePotentials(row, order, distances, length);
    Augment(row, from_column, before);
  }

 private:
  double Cost(int row, int column) const {
    if (column < costs_.cols()) return costs_(row, column);
    return column - costs_.cols() == row ? unassigned_costs_[row] : kInfinity;
  }

  // Keeps reduced costs zero in the matching and non-negative elsewhere.
  void UpdatePotentials(int row, const std::vector<int>& reached, const Eigen::VectorXd& distances,
                        double length) {
    row_potentials_[row] += length;
    for (const int column : reached) {
      column_potentials_[column] -= length - distances[column];
      row_potentials_[RowOf(column)] += length - distances[column];
    }
  }

  void Augment(int row, int free_column, const std::vector<int>& before) {
    for (int column = free_column; column != kUnassigned;) {
      const int previous = before[column];
      row_of_column_[column] = previous == kUnassigned ? row : RowOf(previous);
      column = previous;
    }
  }

  const Eigen::MatrixXd& costs_;
  const Eigen::VectorXd& unassigned_costs_;
  int columns_;
  Eigen::VectorXd row_potentials_;
  Eigen::VectorXd column_potentials_;
  std::vector<int> row_of_column_;
};

}  // namespace

std::vector<int> Assign(const Eigen::MatrixXd& costs, const Eigen::VectorXd& unassigned_costs) {
  const auto rows = static_cast<int>(unassigned_costs.size());
  OptimalMatching matching(costs, unassigned_costs);
  for (int row = 0; row < rows; ++row) matching.Add(row);
  std::vector<int> column_of_row(static_cast<size_t>(rows), kUnassigned);
  for (int column = 0; column < costs.cols(); ++column) {
    const int row = matching.RowOf(column);
    if (row != kUnassigned) column_of_row[row] = column;
  }
  return column_of_row;
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/base/assignment.h"

#include <limits>

namespace soslam {

std::vector<int> Assign(const Eigen::MatrixXd& costs, const Eigen::VectorXd& unassigned_costs) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto rows = static_cast<int>(unassigned_costs.size());
  const auto given_columns = static_cast<int>(costs.cols());
  // The matching is optimal for the rows added so far: reduced costs (those minus both potentials)
  // are zero in it and non-negative elsewhere. Behind the given columns there is one dummy column
  // per row, which stands for no column, so that a row can always be added.
  const int columns = given_columns + rows;
  Eigen::VectorXd row_potentials = Eigen::VectorXd::Zero(rows);
  Eigen::VectorXd column_potentials = Eigen::VectorXd::Zero(columns);
  std::vector<int> row_of_column(static_cast<size_t>(columns), kUnassigned);
  for (int row = 0; row < rows; ++row) {
    // The row is added along the shortest path (by reduced costs) from it to a free column.
    Eigen::VectorXd distances = Eigen::VectorXd::Constant(columns, kInfinity);
    std::vector<int> before(row_of_column.size(), kUnassigned);  // predecessor on the path
    std::vector<bool> reached(row_of_column.size(), false);
    int end = kUnassigned;  // column where the path ends so far
    int end_row = row;
    double length = 0.0;
    do {
      int nearest = kUnassigned;
      for (int column = 0; column < columns; ++column) {
        if (reached[column]) continue;
        const double cost = column < given_columns              ? costs(end_row, column)
                            : column - given_columns == end_row ? unassigned_costs[end_row]
                                                                : kInfinity;
        const double distance = length + cost - row_potentials[end_row] - column_potentials[column];
        if (distance < distances[column]) {
          distances[column] = distance;
          before[column] = end;
        }
        if (nearest == kUnassigned || distances[column] < distances[nearest]) nearest = column;
      }
      length = distances[nearest];
      reached[nearest] = true;
      end = nearest;
      end_row = row_of_column[nearest];
    } while (end_row != kUnassigned);
    row_potentials[row] += length;
    for (int column = 0; column < columns; ++column) {
      if (!reached[column] || column == end) continue;
      column_potentials[column] -= length - distances[column];
      row_potentials[row_of_column[column]] += length - distances[column];
    }
    for (; before[end] != kUnassigned; end = before[end]) {
      row_of_column[end] = row_of_column[before[end]];
    }
    row_of_column[end] = row;
  }
  std::vector<int> column_of_row(static_cast<size_t>(rows), kUnassigned);
  for (int column = 0; column < given_columns; ++column) {
    const int row = row_of_column[column];
    if (row != kUnassigned) column_of_row[row] = column;
  }
  return column_of_row;
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/base/assignment.h"

#include <limits>

namespace soslam {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A matching that is optimal for the rows added so far: reduced costs (those minus both potentials)
// are zero in it and non-negative elsewhere. Behind the given columns there is one dummy column per
// row, which stands for no column, so that a row can always be added. The costs must outlive it.
struct Matching {
  const Eigen::MatrixXd& costs;
  const Eigen::VectorXd& unassigned_costs;
  Eigen::VectorXd row_potentials, column_potentials;
  std::vector<int> row_of_column;

  double Cost(int row, int column) const {
    if (column < costs.cols()) return costs(row, column);
    return column - costs.cols() == row ? unassigned_costs[row] : kInfinity;
  }
};

// Adds a row along the shortest path (by reduced costs) from it to a free column.
void Add(int row, Matching* matching) {
  Eigen::VectorXd& row_potentials = matching->row_potentials;
  Eigen::VectorXd& column_potentials = matching->column_potentials;
  std::vector<int>& row_of_column = matching->row_of_column;
  const auto columns = static_cast<int>(column_potentials.size());
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
      const double distance = length + matching->Cost(end_row, column) - row_potentials[end_row] -
                              column_potentials[column];
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

}  // namespace

std::vector<int> Assign(const Eigen::MatrixXd& costs, const Eigen::VectorXd& unassigned_costs) {
  const auto rows = unassigned_costs.size();
  const auto columns = costs.cols();
  Matching matching = {costs, unassigned_costs, Eigen::VectorXd::Zero(rows),
                       Eigen::VectorXd::Zero(columns + rows),
                       std::vector<int>(static_cast<size_t>(columns + rows), kUnassigned)};
  for (int row = 0; row < rows; ++row) Add(row, &matching);
  std::vector<int> column_of_row(static_cast<size_t>(rows), kUnassigned);
  for (int column = 0; column < columns; ++column) {
    const int row = matching.row_of_column[column];
    if (row != kUnassigned) column_of_row[row] = column;
  }
  return column_of_row;
}

}  // namespace soslam

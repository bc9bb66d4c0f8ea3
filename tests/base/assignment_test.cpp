// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/base/assignment.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "support/random.h"

namespace soslam {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double TotalCost(const Eigen::MatrixXd& costs, const Eigen::VectorXd& unassigned,
                 const std::vector<int>& columns) {
  double total = 0.0;
  for (size_t row = 0; row < columns.size(); ++row) {
    const auto i = static_cast<Eigen::Index>(row);
    total += columns[row] == kUnassigned ? unassigned[i] : costs(i, columns[row]);
  }
  return total;
}

// The least cost over every way to assign the rows from `row` on to columns that are left.
double LeastCost(const Eigen::MatrixXd& costs, const Eigen::VectorXd& unassigned, int row,
                 std::set<int> taken) {
  if (row == costs.rows()) return 0.0;
  double least = unassigned[row] + LeastCost(costs, unassigned, row + 1, taken);
  for (int column = 0; column < costs.cols(); ++column) {
    if (!taken.insert(column).second) continue;
    least = std::min(least, costs(row, column) + LeastCost(costs, unassigned, row + 1, taken));
    taken.erase(column);
  }
  return least;
}

// Also without rows or columns.
TEST(AssignTest, IsAsGoodAsTheBestOfAllWays) {
  for (int trial = 0; trial < 300; ++trial) {
    const int rows = static_cast<int>(RandomUniform(0.0, 5.99));
    const int columns = static_cast<int>(RandomUniform(0.0, 5.99));
    Eigen::MatrixXd costs(rows, columns);
    Eigen::VectorXd unassigned(rows);
    for (int row = 0; row < rows; ++row) {
      unassigned[row] = RandomUniform(-2.0, 8.0);
      for (int column = 0; column < columns; ++column) {
        costs(row, column) = RandomUniform(0.0, 1.0) < 0.2 ? kInfinity : RandomUniform(-5.0, 10.0);
      }
    }
    const std::vector<int> assigned = Assign(costs, unassigned);
    std::set<int> taken;
    for (const int column : assigned) {
      EXPECT_TRUE(column == kUnassigned || taken.insert(column).second) << trial;
    }
    // Sums of at most five numbers below 10.
    EXPECT_NEAR(TotalCost(costs, unassigned, assigned), LeastCost(costs, unassigned, 0, {}), 1e-12)
        << trial;
  }
}

}  // namespace
}  // namespace soslam

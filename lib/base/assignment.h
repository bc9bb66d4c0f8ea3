// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

namespace soslam {

// What stands for no column.
inline constexpr int kUnassigned = -1;

// Gives each row a column of its own, or none, so that the sum of all costs is least; the column of
// each row, or kUnassigned. `costs` (rows x columns) may be infinite where a row cannot have a
// column; `unassigned_costs` (one per row, finite) is what a row without a column costs. Shortest
// augmenting paths (the Hungarian method), O(rows^2 (rows + columns)).
std::vector<int> Assign(const Eigen::MatrixXd& costs, const Eigen::VectorXd& unassigned_costs);

}  // namespace soslam

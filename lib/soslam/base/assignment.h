// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

namespace soslam {

// Marks a row without a column.
inline constexpr int kUnassigned = -1;

// Solves the linear assignment problem: gives each row at most one column of its own so that the
// sum of all costs is minimal, and returns the column of each row or kUnassigned. `costs` (rows x
// columns) may be infinite for forbidden pairs; `unassigned_costs` (one per row, finite) is the
// cost of leaving a row without a column. Shortest augmenting paths (Hungarian method), O(rows^2
// (rows + columns)).
std::vector<int> Assign(const Eigen::MatrixXd& costs, const Eigen::VectorXd& unassigned_costs);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/problem.h>
#include <ceres/solver.h>

namespace soslam {

// Sets the linear solver that needs the shorter time for one step, by counting multiplications: a
// sparse Cholesky decomposition, which follows long thin problems, or, where few blocks are
// connected with most others, as few objects that most frames show, elimination of blocks that are
// not connected with each other, and a dense decomposition of the rest.
void ChooseLinearSolver(const ceres::Problem& problem, ceres::Solver::Options* options);

}  // namespace soslam

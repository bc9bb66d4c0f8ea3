// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/wide_loops.h"

namespace soslam {

// What is left of a symmetric matrix when variables are eliminated: the lower triangle of corner -
// below below^T, n x n, and `below` n x k, the eliminated variables' columns of the Cholesky
// factor, k > 0. May be in place of the corner; above the diagonal nothing is read or written.
// `panels` is memory for a copy of `below`, to be used again by the next call. Sums are in the same
// order in wide registers, which only processors with AVX2 have, and others: the results are the
// same to the last bit.
void SchurComplement(const Eigen::Ref<const Eigen::MatrixXd>& corner,
                     const Eigen::Ref<const Eigen::MatrixXd>& below, std::vector<double>* panels,
                     Eigen::Ref<Eigen::MatrixXd> complement, bool in_wide_registers = HasAvx2());

}  // namespace soslam

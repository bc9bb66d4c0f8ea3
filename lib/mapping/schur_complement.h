// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/wide_loops.h"

namespace soslam {

// The lower triangle of corner - below below^T, which may be in place of the corner; above it
// nothing is read or written. `below` has as many rows as the corner: it is what is left of a
// symmetric matrix when variables are eliminated, `below` their columns of its Cholesky factor.
// `panels` is memory for a copy of `below`, to be used again by the next call. Sums are in the same
// order in wide registers and others, the results the same to the last bit.
void SchurComplement(const Eigen::Ref<const Eigen::MatrixXd>& corner,
                     const Eigen::Ref<const Eigen::MatrixXd>& below, std::vector<double>* panels,
                     Eigen::Ref<Eigen::MatrixXd> complement,
                     bool in_wide_registers = HasWideRegisters());

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "mapping/back_end_variables.h"
#include "mapping/normal_equations.h"

namespace soslam {

// How a minimisation went.
struct Minimisation {
  std::vector<double> costs;  // at the start and after each iteration
  // The last iteration lowered the cost by less than the least gain, or the next is expected to by
  // less than a hundredth of it, or no step lowers it. Where nothing but landmarks varies, only
  // what is expected counts, of each landmark its share.
  bool converged = false;
};

struct MinimiseOptions {
  int max_iterations;
  int threads = 1;
  // A share of the cost. What images say has kinks at every pixel, between which steps would go on
  // to and fro for less.
  double least_gain = 1e-8;
};

// Minimises the sum of all terms over all variables that are not held, from where they are, by
// Levenberg-Marquardt. In each iteration one step of all variables together is followed by steps of
// each landmark for itself: a landmark that its boxes hardly determine so does not shorten the step
// of all others. The result does not depend on the number of threads. Throws NumericalError where
// the cost is not defined at the start.
Minimisation Minimise(const Terms& terms, const MinimiseOptions& options,
                      std::vector<Variable>* variables);

}  // namespace soslam

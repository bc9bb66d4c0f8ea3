// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "mapping/back_end_problem.h"
#include "model/estimates.h"
#include "model/sequence.h"

namespace soslam {

// The cost of a solved problem of bodies of any shape, without images and points, as it is, then
// what it would be if something constant in it were free: the focal length; the heights of all
// planes; their normals and heights; one of several planes alone. Alternatives whose first step
// promises hardly more than chance gives are left out, and all where no object has two boxes. The
// variables stay as they are.
std::vector<InputAlternative> FindInputAlternatives(const Sequence& sequence,
                                                    BackEndProblem* problem);

}  // namespace soslam

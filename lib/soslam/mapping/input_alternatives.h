// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "soslam/mapping/back_end_problem.h"
#include "soslam/model/estimates.h"

namespace soslam {

// The cost of a map, with bodies of any shape, without images and points, as it is, then what it
// would be if something constant in it were free: the focal length; the heights of all planes;
// their normals and heights; one of several planes alone. `solution` is where the back end ended
// with that input. Things of one label in one place resemble each other, so the priors of all count
// as much as that of one.
//
// Alternatives whose first step promises hardly more than chance gives, or a correction that does
// not matter, are left out, and all where no object has two boxes.
std::vector<InputAlternative> FindInputAlternatives(const BackEndInput& input,
                                                    const OptimiseOptions& options,
                                                    const BackEndVariables& solution);

// The largest correction of what is given, in units of the least that matters: 2 % of the focal
// length, 2 cm of a plane's height, 1 degree of its tilt.
double LargestCorrection(const PlaneAlternative& found);
double LargestCorrection(const InputAlternative& found);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "soslam/mapping/back_end.h"
#include "soslam/mapping/options.h"

namespace soslam {

// Throws InputError, which names the first row and value, where an index is not in its list, a list
// that belongs to the objects has another length, a number is not finite, a rotation or normal does
// not have norm 1, the corners of a box are not in order, or a prior is of no body.
void CheckBackEndInput(const BackEndInput& input, const OptimiseOptions& options);
// Checks the initial landmarks, at which CheckBackEndInput does not look.
void CheckInitialLandmarks(const BackEndInput& input);

}  // namespace soslam

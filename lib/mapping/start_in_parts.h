// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mapping/back_end_variables.h"
#include "mapping/normal_equations.h"
#include "model/sequence.h"

namespace soslam {

// Moves poses and landmarks of long drives to where the minimum of all terms can be found from.
// Dead reckoning loses its attitude with time, against which the support planes of everything seen
// later stand. So each segment's frames are solved in parts, one after the other: a part starts as
// the odometry goes on from where the part before it ended, and has terms of its own frames only. A
// landmark that was lost while the poses of its part were not right yet is fitted to them anew, and
// the part is solved again if that tells its poses more. One in several parts comes from the one
// that sees it most often. Planes and the detector's bias stay as they are, as do segments that are
// no longer than four parts. Where all terms of all segments do not cost much less then, as in a
// room that parts see each in its own way, nothing is moved. Returns whether all frames were in
// parts, and moved. Throws NumericalError where a part's cost is not defined.
bool StartInParts(const Sequence& sequence, const Terms& terms, size_t max_frames_per_part,
                  BackEndVariables* variables, int threads = 1);

}  // namespace soslam

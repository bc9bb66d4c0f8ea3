// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "dataset/import_options.h"
#include "model/sequence.h"

namespace soslam {

// Moves the frames that are held out, and what was detected there, out of reach of all estimates:
// to Sequence::held_out. Places of frames are counted from 0 in each segment.
Sequence HoldOutFrames(Sequence sequence, HeldOutFrames held_out);

}  // namespace soslam

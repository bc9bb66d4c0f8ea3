// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "dataset/import_options.h"
#include "model/sequence.h"

namespace soslam {

// Moves the held-out frames and their detections to Sequence::held_out, where no estimate uses
// them. Positions of frames are counted from 0 in each segment.
Sequence HoldOutFrames(Sequence sequence, HeldOutFrames held_out);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "association/association_model.h"

namespace soslam {

// Assigns, frame by frame, the detections to existing tracks (at most one per track) or to new
// tracks at the least total cost. Fills Association::detections and Association::tracks.
Association LinkFrames(const AssociationModel& model, int threads);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "association/association_model.h"

namespace soslam {

// Goes through the frames in order and assigns each one's detections to the tracks so far, at most
// one to a track, or to new tracks, at the least total cost. Fills Association::detections and
// Association::tracks.
Association LinkFrames(const AssociationModel& model, int threads);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "association/association_model.h"

namespace soslam {

// Merges tracks that are one object: when the larger one's landmark explains at least merge_share
// of the smaller one's boxes (of max_views, evenly over all), and they are hardly ever detected in
// the same frame (max_shared_frames). The smallest tracks first, each into the one that explains
// most of it; until none is left to merge. Where a merged object has two detections in a frame, the
// one with the lower score is superseded. Landmarks of tracks that grew are fitted again.
void MergeTracks(const AssociationModel& model, int threads, Association* association);

}  // namespace soslam

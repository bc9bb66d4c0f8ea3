// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "association/association_model.h"

namespace soslam {

// Merges tracks of the same object: the larger track's landmark fits at least merge_share of the
// smaller one's boxes (at most max_views of them, evenly spread), and the two are detected in the
// same frame in at most max_shared_frames of the smaller one's frames; or their bodies take up the
// same place (same_place_overlap). Smallest tracks first, each into the one that fits most of its
// boxes, until no pair is left to merge. Where a merged object has two detections in a frame, the
// one with the lower score is superseded. Landmarks of grown tracks are refitted.
void MergeTracks(const AssociationModel& model, int threads, Association* association);

// Decides which of the tracks left after merging are objects, and sets the fate of all.
void DropFalseTracks(const AssociationModel& model, int threads, Association* association);

}  // namespace soslam

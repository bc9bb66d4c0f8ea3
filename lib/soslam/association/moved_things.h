// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "soslam/association/association_model.h"

namespace soslam {

// A frame in which a track was not detected, though nothing is known to hide it.
struct Miss {
  int frame_index;
  Box outline;  // of its body, inside the image
  double border_px;
};

// The misses of a track: all frames that show its whole body, and no nearer detection before it.
std::vector<Miss> FindMisses(const AssociationModel& model, const Track& track);

// Pairs of objects of one label of which the second is seen only after the first was seen for the
// last time, and that are more probably one thing that was moved than two that the detector
// misses, most probable first. Each place is seen without its object while the other has it.
std::vector<MovedThing> FindMovedThings(const AssociationModel& model,
                                        const Association& association);

// The moved things of an association in words; objects have the ids of AssociatedSequence.
std::vector<Finding> CheckMovedThings(const Sequence& sequence, const Association& association);

}  // namespace soslam

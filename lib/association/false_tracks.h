// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "association/association_model.h"

namespace soslam {

// Decides which of the tracks left after merging are objects, and sets the fate of all.
void DropFalseTracks(const AssociationModel& model, int threads, Association* association);

}  // namespace soslam

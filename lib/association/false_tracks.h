// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "association/association_model.h"

namespace soslam {

// Decides which of the tracks that are left are objects, and why the others are not.
void DropFalseTracks(const AssociationModel& model, int threads, Association* association);

}  // namespace soslam

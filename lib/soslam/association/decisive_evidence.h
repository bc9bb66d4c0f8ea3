// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "soslam/association/association.h"
#include "soslam/association/association_model.h"
#include "soslam/association/pair_evidence.h"

namespace soslam {

// Adds what people look at to judge an object: the pairs of its boxes that hold it together least
// and most, and the tracks that came nearest to being of it (Association::held_least, held_most,
// kept_out), with the evidence by the object's own body. No decision uses it.
void AddDecisiveEvidence(const AssociationModel& model, const PairEvidence& pairs, int threads,
                         Association* association);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "artefact/json_file.h"
#include "association/association.h"
#include "model/sequence.h"

namespace soslam {

// Writes the artefact of kind "associations": the decision and its reason for each detection, track
// and object, and the agreement of the objects with those of the sequence. Objects have the ids
// that AssociatedSequence gives them. Errors as WriteArtefact.
void WriteAssociations(const std::filesystem::path& path, const Sequence& sequence,
                       const Association& association, const Agreement& agreement,
                       const ArtefactInfo& info);

}  // namespace soslam

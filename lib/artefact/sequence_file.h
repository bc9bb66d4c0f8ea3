// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "artefact/json_file.h"
#include "model/sequence.h"

namespace soslam {

// Whether a reader needs the support planes of a sequence.
enum class PlaneNeed { kNeeded, kNotNeeded };

// The artefact of kind "sequence". Files refer to frames, planes and objects by id. ReadSequence
// throws InputError for a file that is missing, of another kind, newer or not valid, and for one
// without the planes that are needed.
Sequence ReadSequence(const std::filesystem::path& path, PlaneNeed need = PlaneNeed::kNeeded);
// Writes the sequence with its own findings. Errors as WriteArtefact.
void WriteSequence(const std::filesystem::path& path, const Sequence& sequence,
                   const ArtefactInfo& info);

}  // namespace soslam

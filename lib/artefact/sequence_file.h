// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "artefact/json_file.h"
#include "model/sequence.h"

namespace soslam {

// The artefact of kind "sequence". Files name frames, planes and objects by id.
// Throws InputError for a file that is missing, of another kind, newer or not valid.
Sequence ReadSequence(const std::filesystem::path& path);
// Errors as WriteArtefact.
void WriteSequence(const std::filesystem::path& path, const Sequence& sequence,
                   const ArtefactInfo& info);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "artefact/json_file.h"
#include "model/reconstruction.h"

namespace soslam {

// Writes and reads reconstruction.json (kind "reconstruction",
// schemas/reconstruction.schema.json). Errors as WriteArtefact and ReadArtefact.
void WriteReconstruction(const std::filesystem::path& path, const ReconstructionSummary& summary,
                         const ArtefactInfo& info);
ReconstructionSummary ReadReconstruction(const std::filesystem::path& path);

}  // namespace soslam

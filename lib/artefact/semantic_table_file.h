// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "artefact/json_file.h"
#include "initialisation/semantic_table.h"

namespace soslam {

// Reads a semantic table (schemas/semantic_table.schema.json), written by people or by
// soslam-learn-priors. Throws InputError.
SemanticTable ReadSemanticTable(const std::filesystem::path& path);
SemanticRows ReadSemanticRows(const std::filesystem::path& path);

// Writes an artefact of kind "semantic_table". Errors as WriteArtefact.
void WriteSemanticRows(const std::filesystem::path& path, const SemanticRows& rows,
                       const ArtefactInfo& info);

}  // namespace soslam

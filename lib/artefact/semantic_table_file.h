// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "initialisation/semantic_table.h"

namespace soslam {

// Reads a semantic table (schemas/semantic_table.schema.json), written by people. Throws
// InputError.
SemanticTable ReadSemanticTable(const std::filesystem::path& path);

}  // namespace soslam

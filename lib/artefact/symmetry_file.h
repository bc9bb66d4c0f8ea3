// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "artefact/json_file.h"
#include "model/symmetry_record.h"

namespace soslam {

// Writes symmetry.h5 (layout: schemas/hdf5-layout.md) atomically. At most one record per frame and
// object. Throws SettingsError when it cannot be written.
void WriteSymmetry(const std::filesystem::path& path, const std::vector<SymmetryRecord>& records,
                   const ArtefactInfo& info);

// The records, sorted by frame id, then object id. Throws InputError when the file is missing,
// damaged, not of kind "symmetry" or too new.
std::vector<SymmetryRecord> ReadSymmetry(const std::filesystem::path& path);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "soslam/artefact/json_file.h"
#include "soslam/model/appearance.h"
#include "soslam/model/sequence.h"

namespace soslam {

// A row of appearance.h5 (layout: schemas/hdf5-layout.md).
struct AppearanceRecord {
  int frame_id = 0;
  int object_id = 0;
  BoxAppearance appearance;
  Eigen::VectorXf descriptor;  // of unit length
  float distance = 0.0F;       // from what the head was trained on, see Head
};

// Writes the records, which have descriptors of one length. Throws SettingsError.
void WriteAppearance(const std::filesystem::path& path,
                     const std::vector<AppearanceRecord>& records, const ArtefactInfo& info);

// Throws InputError when the file is missing, damaged, not of kind "appearance" or too new.
std::vector<AppearanceRecord> ReadAppearance(const std::filesystem::path& path);

// Gives the detections of a sequence what the file says of them. Throws InputError, also for a
// record of none of them.
void AddAppearance(const std::filesystem::path& path, Sequence* sequence);

}  // namespace soslam

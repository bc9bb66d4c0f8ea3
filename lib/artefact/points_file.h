// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "artefact/json_file.h"
#include "model/map_points.h"

namespace soslam {

// Writes points.h5 (layout: schemas/hdf5-layout.md) atomically, points and observations in the
// given order. Throws SettingsError when it cannot be written.
void WritePoints(const std::filesystem::path& path, const std::vector<MapPoint>& points,
                 const ArtefactInfo& info);

// The points in file order. Throws InputError when the file is missing, damaged, not of kind
// "points" or too new, when its arrays do not fit each other, or a number is not possible.
std::vector<MapPoint> ReadPoints(const std::filesystem::path& path);

}  // namespace soslam

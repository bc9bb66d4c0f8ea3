// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "cli/stage_files.h"
#include "initialisation/point_term.h"
#include "model/map_points.h"
#include "model/sequence.h"

namespace soslam {

// Throws SettingsError if points are to be used and no file "points" is given.
void CheckHasPoints(const PointOptions& options, const StageFiles& files);

// The file "points". Throws InputError if the sequence has none of the frames that see them: points
// of another dataset, or of other images, would be no evidence in silence. None at all is what
// soslam-track has warned of.
std::vector<MapPoint> ReadPointsOf(const Sequence& sequence, const StageFiles& files);

}  // namespace soslam

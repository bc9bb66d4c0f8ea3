// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "artefact/hdf5_artefact.h"
#include "cli/stage_files.h"
#include "image/edge_maps.h"
#include "initialisation/point_term.h"
#include "model/map_points.h"
#include "model/sequence.h"

namespace soslam {

// The edge maps of a sequence in file "edges". Both arguments must outlive it.
class EdgesOfSequence {
 public:
  EdgesOfSequence(const Sequence& sequence, const StageFiles& files);
  // Thread-safe. Throws InputError when the frame is missing, or its maps are not of its camera's
  // size, as those of other images.
  EdgeMaps Read(const Frame& frame) const;

 private:
  const Sequence& sequence_;
  const StageFiles& files_;
  EdgesReader reader_;
};

// Throws SettingsError if points are to be used and no file "points" is given.
void CheckHasPoints(const PointOptions& options, const StageFiles& files);

// The file "points". Throws InputError if the sequence has none of the frames that see them: points
// of another dataset, or of other images, would be no evidence in silence. None at all is what
// soslam-track has warned of.
std::vector<MapPoint> ReadPointsOf(const Sequence& sequence, const StageFiles& files);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "soslam/image/feature_tracks.h"
#include "soslam/model/finding.h"
#include "soslam/model/map_points.h"
#include "soslam/model/sequence.h"
#include "soslam/stage/read_evidence.h"

namespace soslam {

struct TrackedPoints {
  std::vector<MapPoint> points;
  size_t tracks = 0;              // from which the points were triangulated
  std::vector<Finding> findings;  // why there is no point
};

// Points from features that are followed through images of a sequence, in the world of its poses.
TrackedPoints TrackPoints(const Sequence& sequence, const std::vector<FrameImage>& images,
                          const TrackOptions& options, int threads);

}  // namespace soslam

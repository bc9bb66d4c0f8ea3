// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "soslam/geometry/box_colours.h"
#include "soslam/model/map_points.h"

namespace soslam {

// Points that the images of a sequence share.
struct ImageMatches {
  std::vector<PointTrack> tracks;
  std::vector<BoxColours> colours = {};  // of each of Sequence::detections
};

}  // namespace soslam

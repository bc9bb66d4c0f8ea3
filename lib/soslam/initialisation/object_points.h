// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "soslam/constraints/object_point.h"
#include "soslam/model/map_points.h"
#include "soslam/model/sequence.h"

namespace soslam {

// Points that may be of one object, in the camera of one of its detections.
struct PointsInView {
  int detection_index;  // in Sequence::detections
  std::vector<ObjectPoint> points;
};
using PointsOfObject = std::vector<PointsInView>;

// The points of each object, by object: those that at least two frames of a segment see in its
// boxes and outside the boxes of nearer objects. Each is in the camera in the middle of these
// frames, with which it moves, as its position is known relative to the cameras that see it.
// Positions are triangulated from the poses of the sequence, whatever the world of `points`, whose
// pixels are without lens distortion (WithoutDistortion). A
// point's prior is 0.7 times the share of its image points, in frames with a box of the object,
// that are in the box, times the probability that it does not lie on the support plane.
std::vector<PointsOfObject> FindObjectPoints(const Sequence& sequence,
                                             const std::vector<MapPoint>& points,
                                             const PointOptions& options);

}  // namespace soslam

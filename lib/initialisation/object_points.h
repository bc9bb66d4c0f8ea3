// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "constraints/point_cost.h"
#include "initialisation/object_evidence.h"
#include "model/estimates.h"
#include "model/map_points.h"
#include "model/sequence.h"

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
// Positions are triangulated from the poses of the sequence, whatever the world of `points`. A
// point's prior is 0.7 times the share of its image points, in frames with a box of the object,
// that are in the box, times the probability that it does not lie on the support plane.
std::vector<PointsOfObject> FindObjectPoints(const Sequence& sequence,
                                             const std::vector<MapPoint>& points,
                                             const PointOptions& options);

// Points in the camera that is the reference.
FurtherEvidence InCamera(const PointEvidence& points);

// Weight of each point of an object, so that all together have the expected weight of
// options.effective_points at most.
double PointWeight(const PointsOfObject& points, const PointOptions& options);

// The points of all objects as evidence in single frames: those that other frames of the segment
// see too, placed by all of them.
class PointsInFrames {
 public:
  // The sequence must outlive this.
  PointsInFrames(const Sequence& sequence, const std::vector<MapPoint>& points,
                 const PointOptions& options);

  // All points of the object of a detection, in its camera, with the widths of the median size of
  // the hypotheses. None without points or hypotheses, and for objects that may move.
  std::optional<PointEvidence> Of(int detection_index,
                                  const std::vector<Hypothesis>& hypotheses) const;

 private:
  const Sequence& sequence_;
  PointOptions options_;
  std::vector<PointsOfObject> points_;  // by object
};

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "soslam/constraints/point_cost.h"
#include "soslam/initialisation/object_evidence.h"
#include "soslam/initialisation/object_points.h"
#include "soslam/model/estimates.h"
#include "soslam/model/map_points.h"
#include "soslam/model/sequence.h"

namespace soslam {

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

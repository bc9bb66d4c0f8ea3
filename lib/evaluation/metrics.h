// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "evaluation/held_out.h"
#include "evaluation/landmark_errors.h"
#include "evaluation/map_quality.h"
#include "model/estimates.h"
#include "model/sequence.h"

namespace soslam {

// Metrics of one ground-truth object: means over its observations (single frame), or its landmark's
// errors. An observation or object without estimate has IoU 0 and no angles.
struct ObjectMetrics {
  int object_index = 0;
  int observations = 0;  // detections of the object
  int estimates = 0;     // landmarks that were compared
  double iou = 0.0;
  std::optional<double> centre_m;
  std::optional<double> rotation_deg;
  std::optional<double> yaw_deg;
  std::optional<double> attitude_deg = {};
  std::optional<WhatIf> what_if = {};  // of single-frame estimates only; 0 without estimate
};

// Summary over objects. Angles: over the objects that have them.
struct MetricsSummary {
  int objects = 0;       // with ground truth
  int observations = 0;  // that were compared
  std::optional<double> iou_mean, iou_median;
  std::optional<double> rotation_deg_mean, rotation_deg_median;
  std::optional<double> yaw_error_deg_mean, yaw_error_deg_median;
  std::optional<WhatIf> what_if = {};
};

struct TrajectoryMetrics {
  double ate_rmse_m = 0.0;
  double odometry_ate_rmse_m = 0.0;
};

struct Metrics {
  MetricsSummary summary;
  std::vector<ObjectMetrics> objects;
  std::optional<MetricsSummary> first_observation;  // for single-frame estimates only
  std::optional<TrajectoryMetrics> trajectory;      // for maps only, if the true poses are known
  std::optional<HeldOutMetrics> held_out;           // if frames were held out
  std::optional<MapQuality> map_quality;            // for maps only, with true objects
};

// Single-frame estimates are compared in the frame of their camera, with the truth of that frame if
// there is one, so that trajectory errors have no effect; estimates over several frames in the
// world, without objects that move. Objects without ground truth or detections are left out. The
// trajectory error is computed for sequences of one segment only. `alignment` is that of
// map_quality.
Metrics EvaluateLandmarks(const Sequence& sequence, const LandmarkEstimates& estimates,
                          AlignmentKind alignment = AlignmentKind::kAuto);
Metrics EvaluateMap(const Sequence& sequence, const MapEstimate& map,
                    AlignmentKind alignment = AlignmentKind::kAuto);

}  // namespace soslam

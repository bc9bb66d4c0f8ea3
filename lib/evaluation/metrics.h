// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "evaluation/held_out.h"
#include "model/estimates.h"
#include "model/sequence.h"

namespace soslam {

// Errors of one landmark. Rotation and yaw are absent for rotationally symmetric objects, whose yaw
// has no meaning; IoU then takes the estimate's yaw for the truth.
struct LandmarkErrors {
  double iou = 0.0;
  double centre_m = 0.0;
  std::optional<double> rotation_deg;  // RotationError
  std::optional<double> yaw_deg;       // YawError
};

// One ground-truth object: means over its observations (single frame), or its landmark's errors. An
// observation or object without estimate counts with IoU 0 and has no angles.
struct ObjectMetrics {
  int object_index = 0;
  int observations = 0;  // detections of the object
  int estimates = 0;     // landmarks that were compared
  double iou = 0.0;
  std::optional<double> centre_m;
  std::optional<double> rotation_deg;
  std::optional<double> yaw_deg;
};

// Over objects. Angles over the objects that have them.
struct MetricsSummary {
  int objects = 0;       // with ground truth
  int observations = 0;  // that were compared
  std::optional<double> iou_mean, iou_median;
  std::optional<double> rotation_deg_mean, rotation_deg_median;
  std::optional<double> yaw_error_deg_mean, yaw_error_deg_median;
};

struct TrajectoryMetrics {
  double ate_rmse_m = 0.0;
  double odometry_ate_rmse_m = 0.0;
};

struct Metrics {
  MetricsSummary summary;
  std::vector<ObjectMetrics> objects;
  std::optional<MetricsSummary> first_observation;  // single-frame estimates only
  std::optional<TrajectoryMetrics> trajectory;      // maps only, where the true poses are known
  std::optional<HeldOutMetrics> held_out;           // where frames were held out
};

LandmarkErrors CompareLandmarks(const Landmark& estimate, const GroundTruth& truth,
                                const Landmark& truth_in_frame);

// Single-frame estimates are compared in the frame of their camera, so that the trajectory's error
// does not count, with the truth of that frame where there is one; estimates over several frames in
// the world, where objects that move do not count. Neither do objects without ground truth, or with
// fewer detections than one. The trajectory error is that of sequences in one segment.
Metrics EvaluateLandmarks(const Sequence& sequence, const LandmarkEstimates& estimates);
Metrics EvaluateMap(const Sequence& sequence, const MapEstimate& map);

}  // namespace soslam

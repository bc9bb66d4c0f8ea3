// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/options.h"

namespace soslam {

enum class TrajectorySource { kOdometry, kGroundTruth };
inline constexpr const char* kTrajectorySourceNames[] = {"odometry", "groundtruth"};

enum class PlanePoses { kGroundTruth, kTrajectory };
inline constexpr const char* kPlanePosesNames[] = {"groundtruth", "trajectory"};

struct ImportOptions {
  TrajectorySource trajectory = TrajectorySource::kOdometry;
  PlanePoses camera_planes = PlanePoses::kGroundTruth;
  int frame_stride = 1;
  double border_px = 30.0;
  int min_observations = 3;
  double max_time_difference_s = 0.02;
  double min_score = 0.0;
  double hidden_edge_fraction = 0.7;

  void Describe(OptionVisitor& visit) {
    visit.Choice("trajectory", &trajectory, kTrajectorySourceNames,
                 "the file with the pose estimates; the other one when it is absent");
    visit.Choice("camera_planes", &camera_planes, kPlanePosesNames,
                 "the poses that carry the annotated world planes into each frame; the trajectory "
                 "when there is no ground truth");
    visit.Integer("frame_stride", &frame_stride, {1, 1000000}, "every n-th image is used");
    visit.Real("border_px", &border_px, {0, 1e5},
               "boxes closer to the image border than this are dropped (px)");
    visit.Integer("min_observations", &min_observations, {1, 1000000},
                  "objects with fewer usable detections lose them all");
    visit.Real("max_time_difference_s", &max_time_difference_s, {0, 1e6},
               "an image takes the pose nearest in time, at most this far away (s)");
    visit.Real("min_score", &min_score, {0, 1}, "detections with a lower score are dropped");
    visit.Real(
        "hidden_edge_fraction", &hidden_edge_fraction, {0, 1},
        "the share of a box's lower edge that must lie inside boxes of nearer objects for it "
        "to be a lower bound only");
  }
};

}  // namespace soslam

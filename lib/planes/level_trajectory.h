// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "geometry/camera.h"
#include "geometry/rigid3.h"
#include "planes/up_prior.h"

namespace soslam {

// Trajectory without drift about the horizontal axes.
struct LevelTrajectory {
  std::vector<Rigid3d> world_from_camera;  // the first pose is unchanged
  UpPrior attitude;                        // of the first camera's world
};

struct LevelOptions {
  double roll_sigma = 0.0;       // see UpPriorFromCameras (rad)
  double pitch_sigma = 0.0;      // (rad)
  double vertical_sigma = 0.0;   // see WithVerticals (rad)
  double odometry_sigma = 0.0;   // rotation between two frames about one axis (rad); 0: exact
  double correlation_rad = 0.0;  // see CameraWeights
  CameraHolding holding = CameraHolding::kLevel;
};

// Removes the drift of odometry about the horizontal axes. Because of drift, up differs from frame
// to frame; it is estimated per frame from the way cameras are held, vertical edges, and continuity
// with the frame before. Poses are rotated so that up is the same as in the first frame everywhere,
// and the translations between frames, as measured in the camera, are concatenated again. At least
// one view.
LevelTrajectory Level(const std::vector<SegmentView>& views, const LevelOptions& options);

}  // namespace soslam

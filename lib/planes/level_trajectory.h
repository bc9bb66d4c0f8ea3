// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "geometry/camera.h"
#include "geometry/rigid3.h"
#include "planes/camera_attitude.h"
#include "planes/verticals.h"

namespace soslam {

// A trajectory without its drift about the horizontal axes.
struct LevelTrajectory {
  std::vector<Rigid3d> world_from_camera;  // the first as it was
  CameraAttitude attitude;                 // of the first camera's world
};

struct LevelOptions {
  double roll_sigma = 0.0;       // see AttitudeOf (rad)
  double pitch_sigma = 0.0;      // (rad)
  double vertical_sigma = 0.0;   // see WithVerticals (rad)
  double odometry_sigma = 0.0;   // of the turn between two frames about one axis (rad); 0: exact
  double correlation_rad = 0.0;  // see ShareOfCameras
  CameraHolding holding = CameraHolding::kLevel;
};

// Odometry drifts: up is not the same direction of its world in every frame, but where how cameras
// are held and vertical edges say, and nearly where it was in the frame before. Poses are turned
// until up is everywhere what it was in the first frame, and the motions between frames, as the
// cameras saw them, joined anew. At least one view.
LevelTrajectory Level(const std::vector<SegmentView>& views, const LevelOptions& options);

}  // namespace soslam

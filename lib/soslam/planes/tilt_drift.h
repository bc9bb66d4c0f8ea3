// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "soslam/geometry/rigid3.h"
#include "soslam/planes/camera_orientation.h"
#include "soslam/planes/options.h"
#include "soslam/planes/up_prior.h"

namespace soslam {

// Trajectory without drift about the horizontal axes.
struct TiltCorrectedTrajectory {
  std::vector<Rigid3d> world_from_camera;  // the first pose is unchanged
  UpPrior up_prior;                        // of the first camera's world
};

// Removes the drift of odometry about the horizontal axes. Because of drift, up differs from frame
// to frame; it is estimated per frame from the way cameras are held, vertical edges, and continuity
// with the frame before. Poses are rotated so that up is the same as in the first frame everywhere,
// and the translations between frames, as measured in the camera, are concatenated again. At least
// one view.
TiltCorrectedTrajectory RemoveTiltDrift(const std::vector<SegmentView>& views,
                                        CameraOrientation orientation,
                                        const PlanesOptions& options);

}  // namespace soslam

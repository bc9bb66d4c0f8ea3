// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "soslam/geometry/rigid3.h"
#include "soslam/model/sequence.h"
#include "soslam/model/shape_prior.h"
#include "soslam/planes/camera_orientation.h"
#include "soslam/planes/options.h"
#include "soslam/planes/planes_estimate.h"
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

// Planes under the most probable camera orientation.
struct PlanesAndOrientation {
  PlanesEstimate estimate;
  Sequence level;  // the sequence with poses that have the same up everywhere
};

// Throws NothingUsableError: nothing tells where a plane is.
[[noreturn]] void ThrowNoPlane(const std::string& sequence);

// Finds the planes for each camera orientation in kCameraOrientations; returns the most probable
// result. `views`: per frame, with the segments among which vertical edges are searched; empty to
// not use vertical edges.
PlanesAndOrientation EstimatePlanesAndOrientation(
    const Sequence& sequence, const std::vector<SegmentView>& views,
    const std::vector<std::optional<ShapePrior>>& priors, const PlanesOptions& options,
    int threads);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "geometry/camera.h"
#include "geometry/rigid3.h"
#include "initialisation/semantic_table.h"
#include "model/sequence.h"
#include "planes/options.h"
#include "planes/planes_estimate.h"
#include "planes/standing_body.h"
#include "planes/up_prior.h"

namespace soslam {

// Trajectory without drift about the horizontal axes.
struct LevelTrajectory {
  std::vector<Rigid3d> world_from_camera;  // the first pose is unchanged
  UpPrior attitude;                        // of the first camera's world
};

// Removes the drift of odometry about the horizontal axes. Because of drift, up differs from frame
// to frame; it is estimated per frame from the way cameras are held, vertical edges, and continuity
// with the frame before. Poses are rotated so that up is the same as in the first frame everywhere,
// and the translations between frames, as measured in the camera, are concatenated again. At least
// one view.
LevelTrajectory Level(const std::vector<SegmentView>& views, CameraHolding holding,
                      const PlanesOptions& options);

// Costs of the objects' boxes, and the cost expected from the boxes' noise alone.
struct BodyCosts {
  std::vector<std::optional<double>> of_objects;  // none: no body fits the boxes
  double expected = 0.0;
};

// Costs with an upright body of free height per object, at the up direction that is best for all
// objects among those that the attitude allows.
BodyCosts CostsOfUprightBodies(const Sequence& sequence,
                               const std::vector<std::optional<ShapePrior>>& priors,
                               const UpPrior& attitude, const PlanesOptions& options, int threads);

// Throws NothingUsableError: no object's views determine the height of its base.
[[noreturn]] void ThrowNoPlanes(const Sequence& sequence);

// Estimates the planes that the sequence's upright objects stand on, from their boxes in several
// frames, the trajectory, the objects' priors and the prior on up. None when no object's views
// determine the height of its base (one view, or all from the same place).
std::optional<PlanesEstimate> FindPlanes(const Sequence& sequence,
                                         const std::vector<std::optional<ShapePrior>>& priors,
                                         const UpPrior& attitude, const PlanesOptions& options,
                                         int threads);

// Evidence after marginalising a height offset of the body from the plane with this standard
// deviation (m).
PlaneEvidence WithHeightNoise(const PlaneEvidence& evidence, double height_sigma);

// Assignment of objects to parallel planes ("levels").
struct PlaneHeights {
  Eigen::Vector2d tilt = Eigen::Vector2d::Zero();  // as in PlaneMotion
  std::vector<double> heights;  // heights of the planes along the tilted normal (m), ascending
  std::vector<int> level_of;    // index in `heights`, for each object
  double cost = 0.0;
};

// Finds the assignment to levels of least cost. Each object gives evidence on the motion of its
// plane; all motions share their rotations and have their own translations, to first order from
// `heights` (m, along the normal), the height of each object's plane. The tilt is searched on a
// grid up to max_tilt (rad) in either direction; `prior` is a prior on the tilt (its translation is
// not used). Every level costs `new_level_cost`. At least one object; each one's information about
// its own height is positive.
PlaneHeights ClusterPlaneHeights(const std::vector<PlaneEvidence>& evidence,
                                 const std::vector<double>& heights, const PlaneEvidence& prior,
                                 double max_tilt, double new_level_cost);

struct PlanesAndHolding {
  PlanesEstimate estimate;
  Sequence level;  // the sequence with poses that have the same up everywhere
};

// EstimatePlanes for each camera holding in kCameraHoldings; returns the most probable result.
// `views`: per frame, with the segments among which vertical edges are searched; empty to not use
// vertical edges.
PlanesAndHolding EstimatePlanesAndHolding(const Sequence& sequence,
                                          const std::vector<SegmentView>& views,
                                          const std::vector<std::optional<ShapePrior>>& priors,
                                          const PlanesOptions& options, int threads);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "soslam/initialisation/points_in_frames.h"
#include "soslam/initialisation/single_frame.h"
#include "soslam/initialisation/upright_options.h"
#include "soslam/model/estimates.h"
#include "soslam/model/sequence.h"
#include "soslam/model/shape_prior.h"

namespace soslam {

// Single-frame landmarks of all detections (one ObservationEstimate each). Detections of objects
// without a ratio fail with no_ratio_for_label.
LandmarkEstimates InitialiseSingleFrame(const Sequence& sequence,
                                        const std::vector<std::optional<Eigen::Vector2d>>& ratios,
                                        const SingleFrameOptions& options, int threads);

// Upright landmarks of any shape exponents for all detections: all hypotheses of FitObject, lowest
// cost first. `yaw_priors`: one per detection, or empty. `points`: none if null.
// Failures: no_ratio_for_label, fewer_than_three_measured_edges, no_solution.
LandmarkEstimates InitialiseUpright(const Sequence& sequence,
                                    const std::vector<std::optional<ShapePrior>>& priors,
                                    const UprightOptions& options, int threads,
                                    const std::vector<std::optional<YawPrior>>& yaw_priors = {},
                                    const PointsInFrames* points = nullptr);

// One upright landmark per object from all of its boxes, with the frames' estimated poses; without
// a prior, a cuboid of free ratio. See WeighViews for the correlation. Failures: moving,
// not_determined_by_its_views.
LandmarkEstimates InitialiseMultiView(const Sequence& sequence,
                                      const std::vector<std::optional<ShapePrior>>& priors,
                                      const UprightOptions& options, int threads);

// One landmark per object by SVD over all of its boxes, with the frames' estimated poses. Failures:
// moving, fewer_than_three_views, no_finite_quadric.
LandmarkEstimates InitialiseSvd(const Sequence& sequence);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "constraints/tangency.h"
#include "geometry/landmark.h"
#include "geometry/plane.h"
#include "initialisation/semantic_table.h"
#include "initialisation/upright.h"
#include "model/sequence.h"

namespace soslam {

// One of several boxes of an object, seen from a known pose.
struct BoxView {
  std::array<BoxEdge, 4> edges;  // in the camera frame
  Rigid3d camera_from_world;
  double weight = 1.0;  // of its cost
};

// What an upright body on a plane is found from.
struct MultiViewObservation {
  std::vector<BoxView> views;
  Plane plane_in_world;
  std::optional<ShapePrior> prior;  // without one the ratio is free, the shape a cuboid's
  bool ratio_is_free = false;       // also with one
  bool height_is_free = false;      // the plane is known by its normal only
  bool size_is_known = false;       // as far as the prior's height_m says
  double axes_weight = 0.0;         // see AxisTerm
  double huber_delta = 1.0;

  double ShapeExponent() const { return prior ? prior->shape_exponent : kCuboidExponent; }
};
// Of one object's detections (indices into Sequence::detections, at least one), from the frames'
// estimated poses, weighted as ViewWeights says for where the rays through the boxes meet.
MultiViewObservation MakeMultiViewObservation(
    const Sequence& sequence, const std::vector<int>& detections,
    const std::optional<ShapePrior>& prior, double detection_sigma_fraction,
    double view_correlation_rad, bool height_is_free = false, bool size_is_known = false);

// What a landmark in the world is fitted to; tangent points are at their depths on `start`. Views
// that it is not wholly in front of are left out.
LandmarkCosts ViewTerms(const MultiViewObservation& observation, const Landmark& start_in_world);

// The same with exact residuals: nothing depends on a start. A landmark that is not wholly in front
// of all views has no finite cost.
LandmarkCosts OutlineTerms(const MultiViewObservation& observation);

// At a given yaw, the tangencies of a cuboid are linear in its foot and its three half axes: the
// least squares solution over all views with the prior's ratio as soft equations, repeated with
// each edge's Huber weight (residuals in px / sigma), tangent depth and, for other exponents, the
// derivative of the support function by the half axes, at the solution before; so with a known
// size. Unlike the SVD of dual quadrics it does not need a wide baseline: plane and ratio hold what
// parallax does not. With a free height that of the foot is one more linear unknown. None when the
// views do not determine the body, or it would not be in front of all cameras.
std::optional<UprightSolution> SolveViewsAtYaw(const MultiViewObservation& observation, double yaw);

// The local optima of these over half a turn in steps (rad), lowest cost first; landmarks in the
// world.
std::vector<UprightSolution> SweepViews(const MultiViewObservation& observation, double step);

// The best of these, polished by Levenberg-Marquardt over yaw as well. Not for a free height.
std::optional<UprightSolution> SolveViews(const MultiViewObservation& observation, double step);

}  // namespace soslam

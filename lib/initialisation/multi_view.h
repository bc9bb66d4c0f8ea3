// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "constraints/tangency.h"
#include "geometry/landmark.h"
#include "geometry/plane.h"
#include "initialisation/upright.h"
#include "model/sequence.h"
#include "model/shape_prior.h"

namespace soslam {

// One box of an object, in a camera of known pose.
struct BoxView {
  std::array<BoxEdge, 4> edges;  // in the camera frame
  Rigid3d camera_from_world;
  double weight = 1.0;  // factor of its cost
};

// Boxes of an upright object on a plane, and its priors.
struct MultiViewObservation {
  std::vector<BoxView> views;
  Plane plane_in_world;
  std::optional<ShapePrior> prior;  // if none, a cuboid of free ratio
  bool ratio_is_free = false;       // the prior's ratio is not used as a cost
  bool height_is_free = false;      // only the normal of the plane is known
  bool size_is_known = false;       // the prior's height_m, if any, is used as a cost
  std::optional<Eigen::Vector3d> scene_axis_in_world = std::nullopt;
  double axes_weight = 0.0;  // see AxisTerm
  double huber_delta = 1.0;

  RestingFace RestsOn() const { return prior ? prior->rests_on : RestingFace::kBottom; }
  ShapeExponents Exponents() const {
    return prior ? prior->shape_exponents : ShapeExponents(kCuboidExponent);
  }
};
// Observation of one object from its detections (indices into Sequence::detections, at least one),
// with the frames' estimated poses, on the object's plane, if it has one. All views have weight 1.
MultiViewObservation MakeMultiViewObservation(const Sequence& sequence,
                                              const std::vector<int>& detections,
                                              const std::optional<ShapePrior>& prior,
                                              double detection_sigma_fraction);

// Gives the views their DirectionWeights about the point nearest to the rays through the boxes and,
// as far as the observation says that they are known, to the plane and the depths from the size.
void WeighViews(double correlation_rad, MultiViewObservation* observation);

// Costs of a landmark in the world: its boxes and priors. The tangent points are at their depths on
// `start`. Views are left out if `start` is not wholly in front of their camera.
LandmarkCosts ViewTerms(const MultiViewObservation& observation, const Landmark& start_in_world);

// The same with exact silhouette residuals, which do not depend on a start. The cost is not finite
// if the landmark is not wholly in front of all cameras.
LandmarkCosts OutlineTerms(const MultiViewObservation& observation);

// Least squares solution over all views at a given yaw. The tangencies of a cuboid are linear in
// its foot and its three half axes; the prior's ratio adds soft equations. The solution is
// iterated: the Huber weights of the edges (residuals in px / sigma), the tangent depths, for other
// exponents the derivatives of the support function by the half axes, and the cost of a known size
// are those at the previous solution. Unlike the SVD of dual quadrics it does not need a wide
// baseline: plane and ratio determine what parallax does not. If the height is free, that of the
// foot is one more linear unknown. None if the views do not determine the object, or if it is not
// in front of all cameras.
std::optional<UprightSolution> SolveViewsAtYaw(const MultiViewObservation& observation, double yaw);

// The yaw (rad) at which grids of yaws begin: that of the horizontal direction from which yaws are
// counted in the first view's camera. If the world is turned, the grids turn along.
double FirstYaw(const MultiViewObservation& observation);

// Local optima of SolveViewsAtYaw over half a turn in steps (rad) from FirstYaw, lowest cost first;
// landmarks in the world.
std::vector<UprightSolution> SweepViews(const MultiViewObservation& observation, double step);

// The best of these optima after refinement by Levenberg-Marquardt with free yaw. Not for a free
// height.
std::optional<UprightSolution> SolveViews(const MultiViewObservation& observation, double step);

}  // namespace soslam

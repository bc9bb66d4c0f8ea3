// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "soslam/constraints/landmark_terms.h"
#include "soslam/constraints/standing_on_plane.h"
#include "soslam/constraints/tangency.h"
#include "soslam/geometry/landmark.h"
#include "soslam/geometry/plane.h"
#include "soslam/initialisation/upright_options.h"
#include "soslam/model/sequence.h"
#include "soslam/model/shape_prior.h"

namespace soslam {

// One box of an object, in a camera of known pose.
struct BoxView {
  std::array<BoxEdge, 4> edges;  // in the camera frame
  Rigid3d camera_from_reference;
  double weight = 1.0;  // factor of its cost
};

// A cost of images or points in one camera that is made anew for each linearisation point; null
// where there is none.
struct FurtherEvidence {
  std::function<std::unique_ptr<const LandmarkCost>(const Landmark& in_camera)> cost_at;
  Rigid3d camera_from_reference;
  double weight = 1.0;
};

// When fits of upright bodies end: where a step lowers the cost by less than this share of 1 + cost
// (zero: see NegligibleDecrease), and where half axes at a fixed yaw change by less than this
// share.
struct FitTolerance {
  double cost = 0.0;
  double half_axes = 1e-6;
};

// All that is known of one upright object, in one frame, the reference: the world, or the camera of
// a single box.
struct ObjectEvidence {
  std::vector<BoxView> views;       // at least one
  Plane plane;                      // the support
  bool height_is_free = false;      // only the normal of the plane is known
  std::optional<ShapePrior> prior;  // if none, a cuboid of free ratio
  bool ratio_is_free = false;       // the prior's ratio is not used as a cost
  // The prior's height_m, if any, is used as a cost; the known length of an object always is.
  bool size_is_known = false;
  std::optional<Eigen::Vector3d> scene_axis = std::nullopt;
  double axes_weight = 0.0;  // see AxisTerm
  std::optional<YawPrior> yaw_prior = std::nullopt;
  // Costs over the whole circle from pictures, at yaws of 2 pi i / kYawsOfPictures; empty without
  // any. Fits use them modulo half a turn (HalfTurnCosts); not of what hangs or is on a wall, as
  // pictures are read with the plane's normal as up.
  std::vector<double> picture_costs = {};
  double huber_delta = 1.0;  // of the boxes; infinite: no loss
  StandingSigmas standing;   // of bodies that may lean
  std::vector<FurtherEvidence> further = {};
  // A cost, none below zero, by which hypotheses are compared, but that is not fitted; may be
  // empty. It may stop, and return anything higher, once it is above the limit.
  std::function<double(const Landmark&, double limit)> compared_cost = {};
  FitTolerance tolerance = {};

  bool MayLean() const { return prior && prior->attitude == Attitude::kFree && !height_is_free; }
  bool HasRatio() const { return prior && !ratio_is_free; }
  bool Stands() const { return !prior || prior->Stands(); }
  bool HasSize() const {
    return prior && prior->height_m && (size_is_known || prior->known_length);
  }
  RestingFace RestsOn() const { return prior ? prior->rests_on : RestingFace::kBottom; }
  ShapeExponents Exponents() const {
    return prior ? prior->shape_exponents : ShapeExponents(kCuboidExponent);
  }
};

inline constexpr int kYawsOfPictures = 72;

// The evidence of the picture in a box, and the ray through the box's centre.
struct PictureView {
  std::shared_ptr<const BoxAppearance> appearance;
  Eigen::Vector3d ray_in_reference;
};

// The pictures of detections (indices into Sequence::detections) that have one, in the world, with
// the frames' estimated poses.
std::vector<PictureView> PicturesInWorld(const Sequence& sequence,
                                         const std::vector<int>& detections);

// The prior of an object's ratios times what its pictures tell of them: a mean of pictures with the
// DirectionWeights of their rays, as sure as one of them, since pictures of one thing share their
// errors. The same prior for an object that need not stand.
std::optional<ShapePrior> PriorWithPictures(const std::optional<ShapePrior>& prior,
                                            std::vector<PictureView> pictures);

// Negative logarithm of the likelihood of each yaw of an object about a plane's normal. Pictures
// are weighted by the DirectionWeights of their rays. Empty if none
// tells an azimuth.
std::vector<double> PictureCosts(std::vector<PictureView> pictures, const Plane& plane);

// Cost of either of two opposite yaws, on half the circle; the lowest is zero.
std::vector<double> HalfTurnCosts(const std::vector<double>& picture_costs);

// Probability that the landmark's x axis is its front, and not its back, from costs over the whole
// circle.
double FrontProbability(const std::vector<double>& picture_costs, const Plane& plane,
                        const Landmark& landmark);

// The edges of a detection's box, without the bias of its label, for fits and the back end.
std::array<BoxEdge, 4> MakeBoxEdges(const Sequence& sequence, const Detection& detection,
                                    const std::optional<ShapePrior>& prior,
                                    const UprightOptions& options);

// Evidence of one object in the world, from its detections (indices into Sequence::detections, at
// least one), with the frames' estimated poses, on the object's plane, if it has one. All views
// have weight 1.
ObjectEvidence EvidenceInWorld(const Sequence& sequence, const std::vector<int>& detections,
                               const std::optional<ShapePrior>& prior,
                               const UprightOptions& options);

// Evidence of one detection in its camera, without a loss.
ObjectEvidence EvidenceInCamera(const Sequence& sequence, const Detection& detection,
                                const std::optional<ShapePrior>& prior,
                                const UprightOptions& options);

// Why an observation has no solution at any yaw.
std::string WhyNoSolution(const ObjectEvidence& evidence);

// Height of a view's box at unit depth.
double HeightAtUnitDepth(const BoxView& view);

// Least squares point of the rays through the centres of all boxes and, as far as they are known,
// of the support plane and the depths from the size.
Eigen::Vector3d NearestToAllRays(const ObjectEvidence& evidence);

// Weights of observations whose errors are correlated when their directions (of any length) are
// near each other: one over the sum of exp(-(angle / correlation)^2 / 2) over all directions, the
// own one included. Directions closer than about `correlation_rad` together count as one: the
// misfit between a label's shape and a box is almost the same in the next frame. All weights are 1
// where it is zero.
std::vector<double> DirectionWeights(const std::vector<Eigen::Vector3d>& directions,
                                     double correlation_rad);

// Gives the views their DirectionWeights about NearestToAllRays.
void WeighViews(double correlation_rad, ObjectEvidence* evidence);

// Costs of a landmark by the priors of ratio, size, scene and yaw; a prior of weight zero has
// none. Single frames, several views and the back end have these terms.
std::vector<std::unique_ptr<const LandmarkTerm>> PriorTerms(const ObjectEvidence& evidence);

// Costs of a landmark: boxes, with the tangent points at their depths on the linearisation point,
// priors, and further evidence made for this point. Views of which the linearisation point is not
// wholly in front are left out.
LandmarkCosts CostsAt(const ObjectEvidence& evidence, const Landmark& linearisation);

// Costs of boxes and priors with exact silhouette residuals, which do not depend on a linearisation
// point. Not finite if the landmark is not wholly in front of all cameras.
LandmarkCosts OutlineCosts(const ObjectEvidence& evidence);

// The cost of a landmark, linearised at itself. An object is in front of all cameras with a box of
// it: each view that it is not in front of costs more than any box.
// With the compared cost only as far as the total may still be below the limit.
struct EvidenceCost {
  double total = 0.0;
  double further = 0.0;   // part of it
  double compared = 0.0;  // part of it
};
EvidenceCost EvaluateCost(const ObjectEvidence& evidence, const Landmark& landmark,
                          double limit = std::numeric_limits<double>::infinity());

// SupportPlane::scene_axis_in_world of a detection's plane.
std::optional<Eigen::Vector3d> SceneAxisInCamera(const Sequence& sequence,
                                                 const Detection& detection);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/planes/estimate_planes.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "soslam/base/parallel.h"
#include "soslam/geometry/angles.h"
#include "soslam/initialisation/fit_object.h"
#include "soslam/planes/plane_heights.h"
#include "soslam/planes/standing_body.h"

namespace soslam {
namespace {

// Standing where there is no prior.
Mount MountOf(const std::optional<ShapePrior>& prior) { return prior.value_or(ShapePrior()).mount; }

// Views per object in the search for up.
constexpr size_t kViewsOfSearch = 12;
constexpr size_t kAllViews = std::numeric_limits<size_t>::max();

constexpr double kYawStep = 3.0 * kRadPerDeg;
constexpr int kMaxRounds = 10;
// Largest tilt in either direction when objects are assigned to planes.
constexpr double kMaxTilt = 8.0 * kRadPerDeg;
// An object takes part in estimating the planes only if the standard deviation of its height is
// below this share of its size.
constexpr double kMaxHeightSigmaBySize = 1.0;

// Expected cost of an object's boxes if they contain only their noise: half the degrees of freedom,
// that is residuals of edges and, if used, two ratios minus the parameters of a body.
double ExpectedCost(const ObjectEvidence& observation) {
  constexpr double kParameters = 7.0;
  const double ratios = observation.ratio_is_free ? 0.0 : 2.0;
  double edges = 0.0;
  for (const BoxView& view : observation.views) edges += 4.0 * view.weight;
  return 0.5 * std::max(1.0, edges + ratios - kParameters);
}

// Per object; none for an object that takes no part.
using Observations = std::vector<std::optional<ObjectEvidence>>;

// The objects with this mount, each with at most `max_views`.
Observations Observe(const Sequence& sequence, const std::vector<std::optional<ShapePrior>>& priors,
                     Mount mount, const PlanesOptions& options, size_t max_views) {
  Observations observations(sequence.objects.size());
  const auto detections = DetectionsByObject(sequence);
  for (size_t i = 0; i < observations.size(); ++i) {
    const auto& prior = priors[i];
    const bool may_lean = prior && prior->attitude == Attitude::kFree;
    // A moving object has no single place in the world.
    if (!sequence.objects[i].is_static || MountOf(prior) != mount || may_lean) continue;
    if (detections[i].empty()) continue;
    ObjectEvidence& observation = observations[i].emplace(
        EvidenceInWorld(sequence, SpreadOver(detections[i], max_views), prior, options.upright));
    observation.height_is_free = true;
    WeighViews(options.upright.ViewCorrelation(), &observation);
    observation.ratio_is_free = prior && prior->attitude != Attitude::kStanding;
  }
  return observations;
}

// The bodies whose own views determine the height of their base, given the normal; by object.
std::map<size_t, StandingBody> FindOwnHeights(const Observations& observations,
                                              const Eigen::Vector3d& normal, int threads) {
  std::vector<std::optional<StandingBody>> found(observations.size());
  ParallelFor("objects", found.size(), threads, [&](size_t i) {
    if (!observations[i]) return;
    auto body = FitBodyAtFreeHeight(*observations[i], normal, kYawStep);
    if (!body) return;
    const double information =
        ComputePlaneEvidence(*body, body->landmark.Centre()).information(2, 2);
    const double size = 2.0 * body->landmark.half_axes.maxCoeff();
    if (information * std::pow(kMaxHeightSigmaBySize * size, 2) > 1.0) found[i] = body;
  });
  std::map<size_t, StandingBody> own;
  for (size_t i = 0; i < found.size(); ++i) {
    if (found[i]) own.emplace(i, *found[i]);
  }
  return own;
}

// Assigns bodies, each on a plane of its own, to shared planes, some of which points tell.
StandingBodies OnSharedPlanes(const std::map<size_t, StandingBody>& own,
                              const std::vector<HeightPrior>& of_points,
                              const Eigen::Vector3d& normal, const UpPrior& up_prior,
                              const PlanesOptions& options) {
  StandingBodies standing{{}, {}, {}, up_prior, options.height_sigma_fraction, of_points};
  for (const auto& [index, body] : own) standing.bodies.push_back(body);
  const Eigen::Vector3d pivot = MeanBasePoint(standing.bodies);
  const Plane reference{normal, -normal.dot(pivot)};
  std::vector<PlaneEvidence> evidence;
  std::vector<double> heights;
  for (const StandingBody& body : standing.bodies) {
    evidence.push_back(WithHeightNoise(ComputePlaneEvidence(body, pivot),
                                       HeightSigma(body, options.height_sigma_fraction)));
    heights.push_back(-body.evidence.plane.SignedDistance(pivot));
  }
  for (const HeightPrior& prior : of_points) {
    const Plane level{normal, -normal.dot(prior.point_in_world)};
    evidence.push_back(ComputePlaneEvidence(prior, level, pivot));
    heights.push_back(-level.SignedDistance(pivot));
  }
  const PlaneHeights levels =
      ClusterPlaneHeights(evidence, heights, ComputePlaneEvidence(up_prior, reference), kMaxTilt,
                          options.new_plane_cost);
  const auto bodies_end =
      levels.level_of.begin() + static_cast<std::ptrdiff_t>(standing.bodies.size());
  standing.plane_of.assign(levels.level_of.begin(), bodies_end);
  standing.plane_of_height.assign(bodies_end, levels.level_of.end());
  const Eigen::Vector2d& tilt = levels.tilt;
  for (const double height : levels.heights) {
    standing.planes.push_back(ApplyMotion(reference, pivot, {tilt.x(), tilt.y(), height}));
  }
  for (size_t i = 0; i < standing.bodies.size(); ++i) {
    StandingBody& body = standing.bodies[i];
    const auto level = static_cast<size_t>(levels.level_of[i]);
    body.landmark =
        ApplyMotion(body.evidence.plane, pivot,
                    {tilt.x(), tilt.y(), levels.heights[level] - heights[i]}, body.landmark);
    body.evidence.plane = standing.planes[level];
  }
  return standing;
}

EstimatedPlane FindEstimatedPlane(const StandingBodies& standing, const RefinedPlanes& refined,
                                  size_t index) {
  const Plane& plane = standing.planes[index];
  std::vector<StandingBody> bodies;
  for (size_t i = 0; i < standing.bodies.size(); ++i) {
    if (standing.plane_of[i] == static_cast<int>(index)) bodies.push_back(standing.bodies[i]);
  }
  std::optional<HeightPrior> of_points;
  for (size_t i = 0; i < standing.heights.size(); ++i) {
    if (standing.plane_of_height[i] != static_cast<int>(index)) continue;
    const HeightPrior& prior = standing.heights[i];
    if (!of_points || prior.sigma_m < of_points->sigma_m) of_points = prior;  // the surest
  }
  const Eigen::Vector3d feet = bodies.empty() ? of_points->point_in_world : MeanBasePoint(bodies);
  const Eigen::Vector3d point = feet - plane.SignedDistance(feet) * plane.normal;
  const Eigen::Matrix3d level = UprightRotation(plane.normal, 0.0).toRotationMatrix();
  const std::array<Eigen::Index, 3> motion = {0, 1, static_cast<Eigen::Index>(2 + index)};
  const Eigen::Matrix3d covariance = refined.covariance(motion, motion);
  // Rotations about the pivot raise the plane at the point.
  Eigen::Matrix3d at_point = Eigen::Matrix3d::Identity();
  const Eigen::Vector3d arm = point - refined.pivot;
  at_point(2, 0) = level.col(1).dot(arm);
  at_point(2, 1) = -level.col(0).dot(arm);
  return {plane, point, level.col(0), at_point * covariance * at_point.transpose(), of_points};
}

// An object's support: the plane that it decided about, if any, or that of lowest cost.
ObjectSupport FindSupport(const ObjectEvidence& evidence, const std::optional<int>& decided,
                          const std::vector<EstimatedPlane>& planes) {
  ObjectSupport support;
  support.reason = decided ? SupportReason::kOwnHeight : SupportReason::kLowestCost;
  if (decided) {
    support.plane_index = *decided;
    const Plane& plane = planes[*decided].plane_in_world;
    if (const auto body = FitBodyAtFreeHeight(evidence, plane.normal, kYawStep)) {
      const Eigen::Vector3d centre = body->landmark.Centre();
      support.height = plane.SignedDistance(centre) - body->landmark.half_axes.z();
      support.height_sigma = 1.0 / std::sqrt(ComputePlaneEvidence(*body, centre).information(2, 2));
    }
  }
  for (size_t i = 0; i < planes.size(); ++i) {
    if (decided && *decided != static_cast<int>(i)) continue;
    ObjectEvidence on_plane = evidence;
    on_plane.plane = planes[i].plane_in_world;
    on_plane.height_is_free = false;
    const auto fits = FitObject(on_plane, kYawStep, 1);
    if (fits.empty() || (support.cost && fits.front().cost.total >= *support.cost)) continue;
    support.cost = fits.front().cost.total;
    support.plane_index = static_cast<int>(i);
  }
  if (!decided && !support.cost) support.reason = SupportReason::kNoBody;
  return support;
}

EstimatedPlane OfPoints(const HeightPrior& prior, const UpPrior& up_prior) {
  const Eigen::Vector3d& up = up_prior.up_in_world;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  covariance.topLeftCorner<2, 2>() = TiltCovariance(up_prior);
  covariance(2, 2) = prior.sigma_m * prior.sigma_m;
  return {{up, -up.dot(prior.point_in_world)},
          prior.point_in_world,
          UprightRotation(up, 0.0) * Eigen::Vector3d::UnitX(),
          covariance,
          prior};
}

// The planes near an up direction. Where no body's views determine the height of its base, they are
// those of points; none if there are no such planes either, or if a fit fails.
std::optional<PlanesEstimate> EstimateFrom(const Eigen::Vector3d& up, const UpPrior& up_prior,
                                           const std::vector<HeightPrior>& of_points,
                                           const Observations& observations,
                                           const Sequence& sequence, const PlanesOptions& options,
                                           int threads) {
  PlanesEstimate estimate;
  estimate.up_of_cameras = up_prior.up_in_world;
  estimate.attitude_information = up_prior.information;
  StandingBodies standing;
  std::optional<RefinedPlanes> refined;
  std::map<size_t, int> plane_of, before;  // by object
  Eigen::Vector3d normal = up;
  for (; estimate.rounds < kMaxRounds && !estimate.settled; ++estimate.rounds) {
    const std::map<size_t, StandingBody> own = FindOwnHeights(observations, normal, threads);
    if (own.empty() && of_points.empty()) return std::nullopt;
    if (own.empty()) {
      standing.planes.clear(), refined.reset(), plane_of.clear();
      break;
    }
    standing = OnSharedPlanes(own, of_points, normal, up_prior, options);
    refined = RefinePlanes(&standing, threads);
    if (!refined) return std::nullopt;
    before = std::exchange(plane_of, {});
    size_t body_index = 0;
    for (const auto& [object, body] : own) plane_of[object] = standing.plane_of[body_index++];
    estimate.settled = before == plane_of;
    normal = standing.planes.front().normal;
  }
  estimate.cost = refined ? refined->cost : 0.0;
  for (const auto& observation : observations) {
    if (observation) estimate.expected_cost += ExpectedCost(*observation);
  }
  for (size_t i = 0; i < standing.planes.size(); ++i) {
    estimate.planes.push_back(FindEstimatedPlane(standing, *refined, i));
  }
  if (standing.planes.empty()) {
    estimate.settled = true;
    for (const HeightPrior& prior : of_points) {
      estimate.planes.push_back(OfPoints(prior, up_prior));
    }
  }
  estimate.objects.resize(observations.size());
  std::vector<char> is_known(observations.size(), 0);
  ParallelFor("objects", observations.size(), threads, [&](size_t i) {
    ObjectSupport& support = estimate.objects[i];
    if (observations[i]) {
      const auto decided = plane_of.find(i);
      support =
          FindSupport(*observations[i],
                      decided == plane_of.end() ? std::nullopt : std::optional(decided->second),
                      estimate.planes);
    } else if (!sequence.objects[i].is_static) {
      support.reason = SupportReason::kMoving;
    }
    is_known[i] = observations[i] && support.reason != SupportReason::kNoBody;
  });
  // Objects of which nothing is known are where most others are; planes of points without an object
  // are left out.
  std::vector<int> objects_on(estimate.planes.size(), 0);
  for (size_t i = 0; i < is_known.size(); ++i) {
    if (is_known[i]) ++objects_on[estimate.objects[i].plane_index];
  }
  const auto most = std::ranges::max_element(objects_on) - objects_on.begin();
  std::vector<EstimatedPlane> all_planes = std::exchange(estimate.planes, {});
  std::vector<int> new_index;
  for (size_t plane = 0; plane < all_planes.size(); ++plane) {
    new_index.push_back(static_cast<int>(estimate.planes.size()));
    if (objects_on[plane] > 0 || static_cast<std::ptrdiff_t>(plane) == most) {
      estimate.planes.push_back(all_planes[plane]);
    }
  }
  for (size_t i = 0; i < is_known.size(); ++i) {
    int& plane = estimate.objects[i].plane_index;
    plane = new_index[is_known[i] ? plane : static_cast<int>(most)];
  }
  return estimate;
}

// The planes of all objects with one mount, the z axes of whose bodies point up as in `up_prior`.
// Empty when no object's boxes determine the height of a plane.
std::optional<PlanesEstimate> EstimatePlanes(const Sequence& sequence,
                                             const std::vector<std::optional<ShapePrior>>& priors,
                                             Mount mount, const UpPrior& up_prior,
                                             const PlanesOptions& options, int threads) {
  const Observations all = Observe(sequence, priors, mount, options, kAllViews);
  const Observations sparse = Observe(sequence, priors, mount, options, kViewsOfSearch);
  const auto is_observed = [](const auto& observation) { return observation.has_value(); };
  if (std::ranges::none_of(all, is_observed)) return std::nullopt;
  std::vector<HeightPrior> of_points;
  if (sequence.ground && mount == Mount::kStanding) of_points = sequence.ground->planes;
  std::optional<PlanesEstimate> best;
  double lowest = 0.0;
  for (const Eigen::Vector3d& up : SearchUp(up_prior, sparse, threads)) {
    auto estimate = EstimateFrom(up, up_prior, of_points, all, sequence, options, threads);
    if (!estimate) continue;
    // The cost of all objects' boxes (including objects that do not decide about planes), of the
    // cameras' up prior, and of the number of planes.
    double cost =
        *estimate->cost + static_cast<double>(estimate->planes.size()) * options.new_plane_cost;
    for (const ObjectSupport& support : estimate->objects) {
      if (support.reason == SupportReason::kLowestCost) {
        cost += support.cost.value_or(kCostWithoutBody);
      }
    }
    if (best && cost >= lowest) continue;
    best = std::move(estimate);
    lowest = cost;
  }
  return best;
}

}  // namespace

BodyCosts CostsOfUprightBodies(const Sequence& sequence,
                               const std::vector<std::optional<ShapePrior>>& priors,
                               const UpPrior& up_prior, const PlanesOptions& options, int threads) {
  BodyCosts costs{std::vector<std::optional<double>>(sequence.objects.size())};
  for (const Mount mount : {Mount::kStanding, Mount::kHanging}) {
    const Observations observations = Observe(sequence, priors, mount, options, kViewsOfSearch);
    const Eigen::Vector3d up = SearchUp(up_prior, observations, threads).front();
    for (size_t i = 0; i < observations.size(); ++i) {
      if (!observations[i]) continue;
      costs.of_objects[i] = CostOfUprightBody(up, *observations[i]);
      costs.expected += ExpectedCost(*observations[i]);
    }
  }
  return costs;
}

std::optional<PlanesEstimate> FindPlanes(const Sequence& sequence,
                                         const std::vector<std::optional<ShapePrior>>& priors,
                                         const UpPrior& up_prior, const PlanesOptions& options,
                                         int threads) {
  const auto floors =
      EstimatePlanes(sequence, priors, Mount::kStanding, up_prior, options, threads);
  // The z axes of hanging objects point down. Ceilings are parallel to floors, if there are any.
  UpPrior down{up_prior.information, -up_prior.up_in_world};
  if (floors) {
    const EstimatedPlane& floor = floors->planes.front();
    down.up_in_world = -floor.plane_in_world.normal;
    // Rotations about x move the normal by -y, those about y by x.
    Eigen::Matrix<double, 3, 2> d_turns;
    d_turns.col(0) = floor.plane_in_world.normal.cross(floor.x_axis_in_world);
    d_turns.col(1) = -floor.x_axis_in_world;
    down.information =
        d_turns * floor.covariance->topLeftCorner<2, 2>().inverse() * d_turns.transpose();
  }
  const auto ceilings = EstimatePlanes(sequence, priors, Mount::kHanging, down, options, threads);
  std::optional<PlanesEstimate> estimate = floors ? floors : ceilings;
  if (!estimate) return std::nullopt;
  if (floors && ceilings) {
    // Each ceiling is made parallel to the floor, through its own point.
    const Eigen::Vector3d normal = -floors->planes.front().plane_in_world.normal;
    for (EstimatedPlane ceiling : ceilings->planes) {
      ceiling.plane_in_world = {normal, -normal.dot(ceiling.point_in_world)};
      const Eigen::Vector3d x = ceiling.x_axis_in_world;
      ceiling.x_axis_in_world = (x - normal.dot(x) * normal).normalized();
      estimate->planes.push_back(ceiling);
    }
    for (size_t i = 0; i < priors.size(); ++i) {
      if (MountOf(priors[i]) != Mount::kHanging) continue;
      estimate->objects[i] = ceilings->objects[i];
      estimate->objects[i].plane_index += static_cast<int>(floors->planes.size());
    }
    estimate->cost = *floors->cost + *ceilings->cost;
    estimate->expected_cost += ceilings->expected_cost;
    estimate->rounds = std::max(floors->rounds, ceilings->rounds);
    estimate->settled = floors->settled && ceilings->settled;
  }
  estimate->up_of_cameras = up_prior.up_in_world;
  estimate->attitude_information = up_prior.information;
  for (size_t i = 0; i < priors.size(); ++i) {
    const Mount mount = MountOf(priors[i]);
    const bool has_planes =
        (mount == Mount::kStanding && floors) || (mount == Mount::kHanging && ceilings);
    if (!has_planes) estimate->objects[i].reason = SupportReason::kNone;
  }
  return estimate;
}

}  // namespace soslam

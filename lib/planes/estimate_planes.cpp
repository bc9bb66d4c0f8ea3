// SPDX-License-Identifier: BSD-3-Clause
#include "planes/estimate_planes.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/parallel.h"
#include "geometry/angles.h"
#include "initialisation/fit_object.h"
#include "planes/plane_heights.h"
#include "planes/standing_body.h"

namespace soslam {
namespace {

// Standing where there is no prior.
Mount MountOf(const std::optional<ShapePrior>& prior) { return prior.value_or(ShapePrior()).mount; }

// Views per object in the search for up.
constexpr size_t kViewsOfSearch = 12;

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

// Estimates the planes of all objects with one mount. The z axes of their bodies point up as in
// `up_prior`.
class Estimator {
 public:
  Estimator(const Sequence& sequence, const std::vector<std::optional<ShapePrior>>& priors,
            Mount mount, const UpPrior& up_prior, const PlanesOptions& options, int threads)
      : sequence_(sequence), options_(options), threads_(threads), up_prior_(up_prior) {
    auto detections = DetectionsByObject(sequence);
    for (size_t i = 0; i < sequence.objects.size(); ++i) {
      // A moving object has no single place in the world.
      const bool takes_part = sequence.objects[i].is_static && MountOf(priors[i]) == mount;
      if (!takes_part) detections[i].clear();
      observations_.push_back(Observe(detections[i], priors[i]));
      sparse_.push_back(Observe(SpreadOver(detections[i], kViewsOfSearch), priors[i]));
    }
  }

  // Adds the costs of the objects with this mount.
  void AddCostsOfUprightBodies(BodyCosts* costs) const {
    const Eigen::Vector3d up = SearchUp(up_prior_, sparse_, threads_).front();
    for (size_t i = 0; i < sparse_.size(); ++i) {
      if (!sparse_[i]) continue;
      costs->of_objects[i] = CostOfUprightBody(up, *sparse_[i]);
      costs->expected += ExpectedCost(*sparse_[i]);
    }
  }

  // None when no object's boxes determine the height of a plane.
  std::optional<PlanesEstimate> Estimate() {
    std::optional<PlanesEstimate> best;
    double lowest = 0.0;
    for (const Eigen::Vector3d& up : SearchUp(up_prior_, sparse_, threads_)) {
      auto estimate = EstimateFrom(up);
      if (!estimate) continue;
      const double cost = CostOfAll(*estimate);
      if (best && cost >= lowest) continue;
      best = std::move(estimate);
      lowest = cost;
    }
    return best;
  }

 private:
  std::optional<ObjectEvidence> Observe(const std::vector<int>& detections,
                                        const std::optional<ShapePrior>& prior) const {
    if (detections.empty() || (prior && prior->attitude == Attitude::kFree)) return std::nullopt;
    ObjectEvidence observation = EvidenceInWorld(sequence_, detections, prior, options_.upright);
    observation.height_is_free = true;
    WeighViews(options_.upright.ViewCorrelation(), &observation);
    observation.ratio_is_free = prior && prior->attitude != Attitude::kStanding;
    observation.size_is_known = options_.size_prior && !observation.ratio_is_free;
    return observation;
  }

  // None when no body's views determine the height of its base, or a fit fails.
  std::optional<PlanesEstimate> EstimateFrom(const Eigen::Vector3d& up) {
    PlanesEstimate estimate;
    estimate.up_of_cameras = up_prior_.up_in_world;
    Plane reference{up, 0.0};
    std::pair<std::vector<size_t>, std::vector<int>> before;
    for (; estimate.rounds < kMaxRounds && !estimate.settled; ++estimate.rounds) {
      FindOwnHeights(reference.normal);
      if (deciding_.empty()) return std::nullopt;
      Decide(&reference);
      if (!RefineAll()) return std::nullopt;
      estimate.settled = before == std::pair(deciding_, standing_.plane_of);
      before = {deciding_, standing_.plane_of};
      reference = standing_.planes.front();
    }
    Write(&estimate);
    return estimate;
  }

  // Cost of all objects' boxes (including objects that do not decide about planes), of the cameras'
  // up prior, and of the number of planes.
  double CostOfAll(const PlanesEstimate& estimate) const {
    double cost =
        *estimate.cost + static_cast<double>(estimate.planes.size()) * options_.new_plane_cost;
    for (const ObjectSupport& support : estimate.objects) {
      if (support.reason == SupportReason::kLowestCost) {
        cost += support.cost.value_or(kCostWithoutBody);
      }
    }
    return cost;
  }

  // Finds the bodies whose own views determine the height of their base, given the normal.
  void FindOwnHeights(const Eigen::Vector3d& normal) {
    std::vector<std::optional<StandingBody>> found(observations_.size());
    ParallelFor("objects", found.size(), threads_, [&](size_t i) {
      if (!observations_[i]) return;
      auto body = FitBodyAtFreeHeight(*observations_[i], normal, kYawStep);
      if (!body) return;
      const double information = EvidenceOf(*body, body->landmark.Centre()).information(2, 2);
      const double size = 2.0 * body->landmark.half_axes.maxCoeff();
      if (information * std::pow(kMaxHeightSigmaBySize * size, 2) > 1.0) found[i] = body;
    });
    deciding_.clear();
    own_.clear();
    for (size_t i = 0; i < found.size(); ++i) {
      if (!found[i]) continue;
      deciding_.push_back(i);
      own_.push_back(*found[i]);
    }
  }

  // Assigns these bodies to shared planes and computes the planes.
  void Decide(Plane* reference) {
    const Eigen::Vector3d pivot = MeanBasePoint(own_);
    *reference = {reference->normal, -reference->normal.dot(pivot)};
    std::vector<PlaneEvidence> evidence;
    std::vector<double> heights;
    for (const StandingBody& body : own_) {
      evidence.push_back(WithHeightNoise(EvidenceOf(body, pivot),
                                         HeightSigma(body, options_.height_sigma_fraction)));
      heights.push_back(-body.evidence.plane.SignedDistance(pivot));
    }
    const PlaneHeights levels = ClusterPlaneHeights(
        evidence, heights, EvidenceOf(up_prior_, *reference), kMaxTilt, options_.new_plane_cost);
    standing_ = {own_, levels.level_of, {}, up_prior_, options_.height_sigma_fraction};
    for (const double height : levels.heights) {
      standing_.planes.push_back(
          Moved(*reference, pivot, {levels.tilt.x(), levels.tilt.y(), height}));
    }
    for (size_t i = 0; i < own_.size(); ++i) {
      StandingBody& body = standing_.bodies[i];
      const Plane own = body.evidence.plane;
      const auto level = static_cast<size_t>(levels.level_of[i]);
      body.landmark =
          Moved(own, pivot, {levels.tilt.x(), levels.tilt.y(), levels.heights[level] - heights[i]},
                body.landmark);
      body.evidence.plane = standing_.planes[level];
    }
  }

  // False when the fit of a body fails.
  bool RefineAll() {
    refined_.clear();
    if (options_.parallel) return RefineTogether(&standing_);
    for (size_t plane = 0; plane < standing_.planes.size(); ++plane) {
      StandingBodies alone{
          {}, {}, {standing_.planes[plane]}, up_prior_, options_.height_sigma_fraction};
      for (size_t i = 0; i < standing_.bodies.size(); ++i) {
        if (standing_.plane_of[i] == static_cast<int>(plane)) {
          alone.bodies.push_back(standing_.bodies[i]);
          alone.plane_of.push_back(0);
        }
      }
      if (!RefineTogether(&alone)) return false;
      standing_.planes[plane] = alone.planes.front();
    }
    return true;
  }

  bool RefineTogether(StandingBodies* standing) {
    auto refined = Refine(standing, threads_);
    if (refined) refined_.push_back(std::move(*refined));
    return refined.has_value();
  }

  void Write(PlanesEstimate* estimate) const {
    estimate->cost = 0.0;
    estimate->attitude_information = up_prior_.information;
    for (const RefinedPlanes& refined : refined_) *estimate->cost += refined.cost;
    for (const auto& observation : observations_) {
      if (observation) estimate->expected_cost += ExpectedCost(*observation);
    }
    for (size_t i = 0; i < standing_.planes.size(); ++i) estimate->planes.push_back(WritePlane(i));
    estimate->objects.resize(sequence_.objects.size());
    ParallelFor("objects", estimate->objects.size(), threads_,
                [&](size_t i) { estimate->objects[i] = WriteObject(i, estimate->planes); });
  }

  EstimatedPlane WritePlane(size_t index) const {
    const Plane& plane = standing_.planes[index];
    std::vector<StandingBody> bodies;
    for (size_t i = 0; i < standing_.bodies.size(); ++i) {
      if (standing_.plane_of[i] == static_cast<int>(index)) bodies.push_back(standing_.bodies[i]);
    }
    const Eigen::Vector3d feet = MeanBasePoint(bodies);
    const Eigen::Vector3d point = feet - plane.SignedDistance(feet) * plane.normal;
    const Eigen::Matrix3d level = UprightRotation(plane.normal, 0.0).toRotationMatrix();
    const RefinedPlanes& refined = options_.parallel ? refined_.front() : refined_[index];
    const auto rise = static_cast<Eigen::Index>(options_.parallel ? 2 + index : 2);
    const std::array<Eigen::Index, 3> motion = {0, 1, rise};
    const Eigen::Matrix3d covariance = refined.covariance(motion, motion);
    // Rotations about the pivot raise the plane at the point.
    Eigen::Matrix3d at_point = Eigen::Matrix3d::Identity();
    const Eigen::Vector3d arm = point - refined.pivot;
    at_point(2, 0) = level.col(1).dot(arm);
    at_point(2, 1) = -level.col(0).dot(arm);
    return {plane, point, level.col(0), at_point * covariance * at_point.transpose()};
  }

  int PlaneOfMost() const {
    std::vector<int> objects(standing_.planes.size(), 0);
    for (const int plane : standing_.plane_of) ++objects[plane];
    return static_cast<int>(std::max_element(objects.begin(), objects.end()) - objects.begin());
  }

  ObjectSupport WriteObject(size_t index, const std::vector<EstimatedPlane>& planes) const {
    ObjectSupport support;
    if (!observations_[index]) {
      support.plane_index = PlaneOfMost();
      if (!sequence_.objects[index].is_static) support.reason = SupportReason::kMoving;
      return support;
    }
    const auto deciding = std::find(deciding_.begin(), deciding_.end(), index);
    const bool decides = deciding != deciding_.end();
    if (decides) {
      support.plane_index = standing_.plane_of[deciding - deciding_.begin()];
      WriteOwnHeight(index, planes[support.plane_index].plane_in_world, &support);
    }
    support.reason = decides ? SupportReason::kOwnHeight : SupportReason::kLowestCost;
    for (size_t i = 0; i < planes.size(); ++i) {
      if (decides && support.plane_index != static_cast<int>(i)) continue;
      ObjectEvidence observation = *observations_[index];
      observation.plane = planes[i].plane_in_world;
      observation.height_is_free = false;
      const auto fits = FitObject(observation, kYawStep, 1);
      if (fits.empty() || (support.cost && fits.front().cost.total >= *support.cost)) continue;
      support.cost = fits.front().cost.total;
      support.plane_index = static_cast<int>(i);
    }
    if (!decides && !support.cost) {
      support.plane_index = PlaneOfMost();
      support.reason = SupportReason::kNoBody;
    }
    return support;
  }

  void WriteOwnHeight(size_t index, const Plane& plane, ObjectSupport* support) const {
    const auto body = FitBodyAtFreeHeight(*observations_[index], plane.normal, kYawStep);
    if (!body) return;
    const Eigen::Vector3d centre = body->landmark.Centre();
    support->height = plane.SignedDistance(centre) - body->landmark.half_axes.z();
    support->height_sigma = 1.0 / std::sqrt(EvidenceOf(*body, centre).information(2, 2));
  }

  const Sequence& sequence_;
  const PlanesOptions& options_;
  int threads_;
  UpPrior up_prior_;
  // Per object; none for an object without detections.
  std::vector<std::optional<ObjectEvidence>> observations_;
  std::vector<std::optional<ObjectEvidence>> sparse_;
  // Objects that decide about planes, and their bodies, each on its own plane.
  std::vector<size_t> deciding_;
  std::vector<StandingBody> own_;
  StandingBodies standing_;
  std::vector<RefinedPlanes> refined_;  // one for all planes where they are parallel
};

// Up prior for hanging objects, whose z axes point down. Ceilings are parallel to floors, if there
// are any.
UpPrior DownOf(const UpPrior& up_prior, const std::optional<PlanesEstimate>& floors) {
  UpPrior down{up_prior.information, -up_prior.up_in_world};
  if (!floors) return down;
  const EstimatedPlane& floor = floors->planes.front();
  down.up_in_world = -floor.plane_in_world.normal;
  // Rotations about x move the normal by -y, those about y by x.
  Eigen::Matrix<double, 3, 2> d_turns;
  d_turns.col(0) = floor.plane_in_world.normal.cross(floor.x_axis_in_world);
  d_turns.col(1) = -floor.x_axis_in_world;
  down.information =
      d_turns * floor.covariance->topLeftCorner<2, 2>().inverse() * d_turns.transpose();
  return down;
}

// Floors and ceilings in one estimate, with the objects of each on their own planes; ceilings are
// made parallel to the floor if `parallel`.
PlanesEstimate JoinedPlanes(const PlanesEstimate& floors, const PlanesEstimate& ceilings,
                            bool parallel, const std::vector<std::optional<ShapePrior>>& priors) {
  PlanesEstimate joined = floors;
  const Eigen::Vector3d down = -floors.planes.front().plane_in_world.normal;
  for (EstimatedPlane ceiling : ceilings.planes) {
    if (parallel) {  // made parallel to the floor, through its own point
      ceiling.plane_in_world = {down, -down.dot(ceiling.point_in_world)};
      const Eigen::Vector3d x = ceiling.x_axis_in_world;
      ceiling.x_axis_in_world = (x - down.dot(x) * down).normalized();
    }
    joined.planes.push_back(ceiling);
  }
  for (size_t i = 0; i < priors.size(); ++i) {
    if (MountOf(priors[i]) != Mount::kHanging) continue;
    joined.objects[i] = ceilings.objects[i];
    joined.objects[i].plane_index += static_cast<int>(floors.planes.size());
  }
  joined.cost = *floors.cost + *ceilings.cost;
  joined.expected_cost += ceilings.expected_cost;
  joined.rounds = std::max(floors.rounds, ceilings.rounds);
  joined.settled = floors.settled && ceilings.settled;
  return joined;
}

}  // namespace

BodyCosts CostsOfUprightBodies(const Sequence& sequence,
                               const std::vector<std::optional<ShapePrior>>& priors,
                               const UpPrior& up_prior, const PlanesOptions& options, int threads) {
  BodyCosts costs{std::vector<std::optional<double>>(sequence.objects.size())};
  for (const Mount mount : {Mount::kStanding, Mount::kHanging}) {
    Estimator(sequence, priors, mount, up_prior, options, threads).AddCostsOfUprightBodies(&costs);
  }
  return costs;
}

std::optional<PlanesEstimate> FindPlanes(const Sequence& sequence,
                                         const std::vector<std::optional<ShapePrior>>& priors,
                                         const UpPrior& up_prior, const PlanesOptions& options,
                                         int threads) {
  const auto planes_of = [&](Mount mount, const UpPrior& up) {
    return Estimator(sequence, priors, mount, up, options, threads).Estimate();
  };
  const auto floors = planes_of(Mount::kStanding, up_prior);
  const auto ceilings = planes_of(Mount::kHanging, DownOf(up_prior, floors));
  std::optional<PlanesEstimate> estimate = floors ? floors : ceilings;
  if (!estimate) return std::nullopt;
  if (floors && ceilings) estimate = JoinedPlanes(*floors, *ceilings, options.parallel, priors);
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

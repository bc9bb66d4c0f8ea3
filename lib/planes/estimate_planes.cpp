// SPDX-License-Identifier: BSD-3-Clause
#include "planes/estimate_planes.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "planes/levels.h"
#include "planes/standing_bodies.h"

namespace soslam {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;

// Where up may be before boxes are looked at: this far (standard deviations) from the cameras' up.
constexpr double kMaxSigmas = 2.5;
constexpr double kMaxTiltOfCameras = 45.0 * kRadians;
constexpr double kTiltStep = 7.5 * kRadians;
// For that search, of each object.
constexpr size_t kViewsOfSearch = 12;
// Directions that all the rest is tried from, farther apart than neighbours of the grid.
constexpr size_t kStarts = 4;
constexpr double kBetweenStarts = 1.6 * kTiltStep;
constexpr double kYawStepOfSearch = 6.0 * kRadians;
// A direction of up in which an object has no body is worse than any in which it has one.
constexpr double kCostWithoutBody = 1e4;

constexpr double kYawStep = 3.0 * kRadians;
constexpr int kMaxRounds = 10;
// Either way, of deciding who stands where.
constexpr double kMaxTilt = 8.0 * kRadians;
// An object whose height is known no better than to this share of its size does not decide.
constexpr double kMaxHeightSigmaBySize = 1.0;

// Directions around the cameras' up, itself first.
std::vector<Eigen::Vector3d> UpCandidates(const CameraAttitude& attitude) {
  const Eigen::Quaterniond level = UprightRotation(attitude.up_in_world, 0.0);
  const double lowest = attitude.up_in_world.dot(attitude.information * attitude.up_in_world);
  const int steps = static_cast<int>(kMaxTiltOfCameras / kTiltStep);
  std::vector<Eigen::Vector3d> candidates = {attitude.up_in_world};
  for (int i = -steps; i <= steps; ++i) {
    for (int k = -steps; k <= steps; ++k) {
      const Eigen::Vector3d turn(i * kTiltStep, k * kTiltStep, 0.0);
      if ((i == 0 && k == 0) || turn.norm() > kMaxTiltOfCameras) continue;
      const Eigen::Vector3d up = ExpRotation(level * turn) * attitude.up_in_world;
      if (up.dot(attitude.information * up) - lowest > kMaxSigmas * kMaxSigmas) continue;
      candidates.push_back(up);
    }
  }
  return candidates;
}

Mount MountOf(const std::optional<ShapePrior>& prior) { return prior.value_or(ShapePrior()).mount; }

// The planes of the objects that are mounted in one way, on bodies whose z axes are up as the
// attitude has it.
class Estimator {
 public:
  Estimator(const Sequence& sequence, const std::vector<std::optional<ShapePrior>>& priors,
            Mount mount, const CameraAttitude& attitude, const PlanesOptions& options, int threads)
      : sequence_(sequence),
        options_(options),
        threads_(threads),
        detections_(DetectionsByObject(sequence)),
        attitude_(attitude) {
    for (size_t i = 0; i < sequence.objects.size(); ++i) {
      // What moves is in no one place in the world.
      const bool takes_part = sequence.objects[i].is_static && MountOf(priors[i]) == mount;
      if (!takes_part) detections_[i].clear();
      observations_.push_back(Observe(detections_[i], priors[i]));
      sparse_.push_back(Observe(SpreadOver(detections_[i], kViewsOfSearch), priors[i]));
    }
  }

  // None when no object's boxes determine the height of a plane.
  std::optional<PlanesEstimate> Estimate() {
    std::optional<PlanesEstimate> best;
    double lowest = 0.0;
    for (const Eigen::Vector3d& up : SearchUp()) {
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
  std::optional<MultiViewObservation> Observe(const std::vector<int>& detections,
                                              const std::optional<ShapePrior>& prior) const {
    if (detections.empty()) return std::nullopt;
    MultiViewObservation observation =
        MakeMultiViewObservation(sequence_, detections, prior, options_.detection_sigma_fraction,
                                 options_.view_correlation_deg * kRadians, /*height_is_free=*/true);
    observation.huber_delta = options_.huber_delta;
    observation.size_is_known = options_.size_prior;
    return observation;
  }

  // None when no body's views determine the height of its foot, or a body is lost.
  std::optional<PlanesEstimate> EstimateFrom(const Eigen::Vector3d& up) {
    PlanesEstimate estimate;
    estimate.up_of_cameras = attitude_.up_in_world;
    Plane reference{up, 0.0};
    std::pair<std::vector<size_t>, std::vector<int>> before;
    for (; estimate.rounds < kMaxRounds && !estimate.settled; ++estimate.rounds) {
      FindOwnHeights(reference.normal);
      if (deciding_.empty()) return std::nullopt;
      Decide(&reference);
      if (!RefineAll()) return std::nullopt;
      estimate.settled = before == std::pair(deciding_, deciding_level_);
      before = {deciding_, deciding_level_};
      reference = standing_.planes.front();
    }
    Write(&estimate);
    return estimate;
  }

  // Of every object's boxes, also of those that do not decide, the cameras' attitude and the number
  // of planes.
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

  // Of the directions that the cameras leave open, those in which upright bodies of any height
  // explain the boxes best, lowest cost first: where bodies turn over to another of their axes the
  // cost has several minima.
  std::vector<Eigen::Vector3d> SearchUp() const {
    const std::vector<Eigen::Vector3d> candidates = UpCandidates(attitude_);
    std::vector<double> costs(candidates.size());
    ParallelFor("directions of up", static_cast<int>(candidates.size()), threads_, [&](int i) {
      const Eigen::Vector3d& up = candidates[static_cast<size_t>(i)];
      double cost = 0.5 * up.dot(attitude_.information * up);
      for (auto observation : sparse_) {
        if (!observation) continue;
        observation->plane_in_world = {up, 0.0};
        const auto optima = SweepViews(*observation, kYawStepOfSearch);
        cost += optima.empty() ? kCostWithoutBody : optima.front().cost;
      }
      costs[static_cast<size_t>(i)] = cost;
    });
    std::vector<size_t> order(candidates.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](size_t one, size_t other) { return costs[one] < costs[other]; });
    std::vector<Eigen::Vector3d> starts;
    for (const size_t i : order) {
      const bool is_apart = std::all_of(starts.begin(), starts.end(), [&](const auto& start) {
        return start.dot(candidates[i]) < std::cos(kBetweenStarts);
      });
      if (is_apart) starts.push_back(candidates[i]);
      if (starts.size() == kStarts) break;
    }
    return starts;
  }

  // The bodies whose own views determine the height of their foot, the normal being given.
  void FindOwnHeights(const Eigen::Vector3d& normal) {
    std::vector<std::optional<StandingBody>> found(observations_.size());
    ParallelFor("objects", static_cast<int>(found.size()), threads_, [&](int i) {
      const auto index = static_cast<size_t>(i);
      if (!observations_[index]) return;
      auto body = BodyOfFreeHeight(*observations_[index], normal, kYawStep);
      if (!body) return;
      const double information = EvidenceOf(*body, body->landmark.Centre()).information(2, 2);
      const double size = 2.0 * body->landmark.half_axes.maxCoeff();
      if (information * std::pow(kMaxHeightSigmaBySize * size, 2) > 1.0) found[index] = body;
    });
    deciding_.clear();
    own_.clear();
    for (size_t i = 0; i < found.size(); ++i) {
      if (!found[i]) continue;
      deciding_.push_back(i);
      own_.push_back(*found[i]);
    }
  }

  // Which of these bodies share a plane, and the planes.
  void Decide(Plane* reference) {
    const Eigen::Vector3d pivot = MiddleOfFeet(own_);
    *reference = {reference->normal, -reference->normal.dot(pivot)};
    std::vector<PlaneEvidence> evidence;
    std::vector<double> heights;
    for (const StandingBody& body : own_) {
      evidence.push_back(
          Loosened(EvidenceOf(body, pivot), HeightSigma(body, options_.height_sigma_fraction)));
      heights.push_back(-body.observation.plane_in_world.SignedDistance(pivot));
    }
    const Levels levels = FindLevels(evidence, heights, EvidenceOf(attitude_, *reference), kMaxTilt,
                                     options_.new_plane_cost);
    deciding_level_ = levels.level_of;
    standing_ = {own_, levels.level_of, {}, attitude_, options_.height_sigma_fraction};
    for (const double height : levels.heights) {
      standing_.planes.push_back(
          Moved(*reference, pivot, {levels.tilt.x(), levels.tilt.y(), height}));
    }
    for (size_t i = 0; i < own_.size(); ++i) {
      StandingBody& body = standing_.bodies[i];
      const Plane own = body.observation.plane_in_world;
      const auto level = static_cast<size_t>(levels.level_of[i]);
      body.landmark =
          Moved(own, pivot, {levels.tilt.x(), levels.tilt.y(), levels.heights[level] - heights[i]},
                body.landmark);
      body.observation.plane_in_world = standing_.planes[level];
    }
  }

  // False when a body is lost.
  bool RefineAll() {
    refined_.clear();
    if (options_.parallel) return RefineTogether(&standing_);
    for (size_t plane = 0; plane < standing_.planes.size(); ++plane) {
      StandingBodies alone{
          {}, {}, {standing_.planes[plane]}, attitude_, options_.height_sigma_fraction};
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

  // The covariance of one plane's motion, through refined_'s pivot.
  Eigen::Matrix3d CovarianceOf(size_t plane) const {
    const RefinedPlanes& refined = options_.parallel ? refined_.front() : refined_[plane];
    const auto rise = static_cast<Eigen::Index>(options_.parallel ? 2 + plane : 2);
    const std::array<Eigen::Index, 3> at = {0, 1, rise};
    Eigen::Matrix3d covariance;
    for (Eigen::Index i = 0; i < 3; ++i) {
      for (Eigen::Index k = 0; k < 3; ++k) covariance(i, k) = refined.covariance(at[i], at[k]);
    }
    return covariance;
  }

  void Write(PlanesEstimate* estimate) const {
    estimate->cost = 0.0;
    estimate->attitude_information = attitude_.information;
    for (const RefinedPlanes& refined : refined_) *estimate->cost += refined.cost;
    for (size_t i = 0; i < standing_.planes.size(); ++i) estimate->planes.push_back(WritePlane(i));
    estimate->objects.resize(sequence_.objects.size());
    ParallelFor("objects", static_cast<int>(estimate->objects.size()), threads_, [&](int i) {
      estimate->objects[static_cast<size_t>(i)] =
          WriteObject(static_cast<size_t>(i), estimate->planes);
    });
  }

  EstimatedPlane WritePlane(size_t index) const {
    const Plane& plane = standing_.planes[index];
    std::vector<StandingBody> bodies;
    for (size_t i = 0; i < standing_.bodies.size(); ++i) {
      if (standing_.plane_of[i] == static_cast<int>(index)) bodies.push_back(standing_.bodies[i]);
    }
    const Eigen::Vector3d feet = MiddleOfFeet(bodies);
    const Eigen::Vector3d point = feet - plane.SignedDistance(feet) * plane.normal;
    const Eigen::Matrix3d level = UprightRotation(plane.normal, 0.0).toRotationMatrix();
    // Turns about the pivot raise the plane at the point.
    const Eigen::Vector3d& pivot =
        options_.parallel ? refined_.front().pivot : refined_[index].pivot;
    Eigen::Matrix3d at_point = Eigen::Matrix3d::Identity();
    const Eigen::Vector3d arm = point - pivot;
    at_point(2, 0) = level.col(1).dot(arm);
    at_point(2, 1) = -level.col(0).dot(arm);
    return {plane, point, level.col(0), at_point * CovarianceOf(index) * at_point.transpose()};
  }

  int PlaneOfMost() const {
    std::vector<int> objects(standing_.planes.size(), 0);
    for (const int plane : standing_.plane_of) ++objects[static_cast<size_t>(plane)];
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
      support.plane_index = standing_.plane_of[static_cast<size_t>(deciding - deciding_.begin())];
      WriteOwnHeight(index, planes[static_cast<size_t>(support.plane_index)].plane_in_world,
                     &support);
    }
    support.reason = decides ? SupportReason::kOwnHeight : SupportReason::kLowestCost;
    for (size_t i = 0; i < planes.size(); ++i) {
      if (decides && support.plane_index != static_cast<int>(i)) continue;
      MultiViewObservation observation = *observations_[index];
      observation.plane_in_world = planes[i].plane_in_world;
      observation.height_is_free = false;
      const auto solution = SolveViews(observation, kYawStep);
      if (!solution || (support.cost && solution->cost >= *support.cost)) continue;
      support.cost = solution->cost;
      support.plane_index = static_cast<int>(i);
    }
    if (!decides && !support.cost) {
      support.plane_index = PlaneOfMost();
      support.reason = SupportReason::kNoBody;
    }
    return support;
  }

  void WriteOwnHeight(size_t index, const Plane& plane, ObjectSupport* support) const {
    const auto body = BodyOfFreeHeight(*observations_[index], plane.normal, kYawStep);
    if (!body) return;
    const Eigen::Vector3d centre = body->landmark.Centre();
    support->height = plane.SignedDistance(centre) - body->landmark.half_axes.z();
    support->height_sigma = 1.0 / std::sqrt(EvidenceOf(*body, centre).information(2, 2));
  }

  const Sequence& sequence_;
  const PlanesOptions& options_;
  int threads_;
  std::vector<std::vector<int>> detections_;
  CameraAttitude attitude_;
  // By object; none without detections.
  std::vector<std::optional<MultiViewObservation>> observations_;
  std::vector<std::optional<MultiViewObservation>> sparse_;
  // Objects that decide about planes, and their bodies, each on its own plane.
  std::vector<size_t> deciding_;
  std::vector<StandingBody> own_;
  std::vector<int> deciding_level_;
  StandingBodies standing_;
  std::vector<RefinedPlanes> refined_;  // one for all planes where they are parallel
};

// What is known of down, z of what hangs: ceilings are level where floors are.
CameraAttitude Down(const CameraAttitude& attitude, const std::optional<PlanesEstimate>& floors) {
  CameraAttitude down{attitude.information, -attitude.up_in_world};
  if (!floors) return down;
  const EstimatedPlane& floor = floors->planes.front();
  down.up_in_world = -floor.plane_in_world.normal;
  // Turns about x move the normal by -y, those about y by x.
  Eigen::Matrix<double, 3, 2> by_turns;
  by_turns.col(0) = floor.plane_in_world.normal.cross(floor.x_axis_in_world);
  by_turns.col(1) = -floor.x_axis_in_world;
  down.information =
      by_turns * floor.covariance->topLeftCorner<2, 2>().inverse() * by_turns.transpose();
  return down;
}

// Level where the floor is, through the same point.
EstimatedPlane Opposite(const EstimatedPlane& floor, EstimatedPlane ceiling) {
  const Eigen::Vector3d normal = -floor.plane_in_world.normal;
  ceiling.plane_in_world = {normal, -normal.dot(ceiling.point_in_world)};
  const Eigen::Vector3d& x = ceiling.x_axis_in_world;
  ceiling.x_axis_in_world = (x - normal.dot(x) * normal).normalized();
  return ceiling;
}

// Both, with the objects of each on their own planes; parallel if they are to be.
PlanesEstimate Joined(const PlanesEstimate& floors, const PlanesEstimate& ceilings, bool parallel,
                      const std::vector<std::optional<ShapePrior>>& priors) {
  PlanesEstimate joined = floors;
  for (const EstimatedPlane& ceiling : ceilings.planes) {
    joined.planes.push_back(parallel ? Opposite(floors.planes.front(), ceiling) : ceiling);
  }
  for (size_t i = 0; i < priors.size(); ++i) {
    if (MountOf(priors[i]) != Mount::kHanging) continue;
    joined.objects[i] = ceilings.objects[i];
    joined.objects[i].plane_index += static_cast<int>(floors.planes.size());
  }
  joined.cost = *floors.cost + *ceilings.cost;
  joined.rounds = std::max(floors.rounds, ceilings.rounds);
  joined.settled = floors.settled && ceilings.settled;
  return joined;
}

}  // namespace

PlanesEstimate EstimatePlanes(const Sequence& sequence,
                              const std::vector<std::optional<ShapePrior>>& priors,
                              const CameraAttitude& attitude, const PlanesOptions& options,
                              int threads) {
  const auto planes_of = [&](Mount mount, const CameraAttitude& up) {
    return Estimator(sequence, priors, mount, up, options, threads).Estimate();
  };
  const auto floors = planes_of(Mount::kStanding, attitude);
  const auto ceilings = planes_of(Mount::kHanging, Down(attitude, floors));
  if (!floors && !ceilings) {
    throw NothingUsableError(fmt::format(
        "{}: no object's boxes determine the height of the plane that it stands on or hangs from; "
        "expected an object seen from several places, or planes = given",
        sequence.name));
  }
  PlanesEstimate estimate = !ceilings ? *floors
                            : !floors ? *ceilings
                                      : Joined(*floors, *ceilings, options.parallel, priors);
  estimate.up_of_cameras = attitude.up_in_world;
  estimate.attitude_information = attitude.information;
  for (size_t i = 0; i < priors.size(); ++i) {
    const Mount mount = MountOf(priors[i]);
    const bool has_planes = mount == Mount::kStanding  ? floors.has_value()
                            : mount == Mount::kHanging ? ceilings.has_value()
                                                       : false;
    if (!has_planes) estimate.objects[i].reason = SupportReason::kNone;
  }
  return estimate;
}

}  // namespace soslam

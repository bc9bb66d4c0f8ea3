// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/planes/up_prior.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "soslam/base/parallel.h"
#include "soslam/constraints/loss.h"
#include "soslam/geometry/angles.h"
#include "soslam/geometry/landmark.h"
#include "soslam/initialisation/fit_object.h"

namespace soslam {

Eigen::Matrix<double, 3, 2> UpByTurns(const Eigen::Vector3d& up) {
  const Eigen::Matrix3d level = UprightRotation(up, 0.0).toRotationMatrix();
  Eigen::Matrix<double, 3, 2> d_turns;
  d_turns << -level.col(1), level.col(0);
  return d_turns;
}

Eigen::Matrix2d TiltCovariance(const UpPrior& prior) {
  const Eigen::Matrix<double, 3, 2> d_turns = UpByTurns(prior.up_in_world);
  return (d_turns.transpose() * prior.information * d_turns).inverse();
}

UpPrior WithTiltCovariance(const Eigen::Vector3d& up_in_world, const Eigen::Matrix2d& covariance) {
  const Eigen::Matrix<double, 3, 2> d_turns = UpByTurns(up_in_world);
  return {d_turns * covariance.inverse() * d_turns.transpose(), up_in_world};
}

std::vector<double> CameraWeights(const std::vector<Rigid3d>& world_from_camera,
                                  double correlation_rad) {
  std::vector<Eigen::Vector3d> optical_axes;
  for (const Rigid3d& pose : world_from_camera) {
    optical_axes.emplace_back(pose.rotation * Eigen::Vector3d::UnitZ());
  }
  return DirectionWeights(optical_axes, correlation_rad);
}

namespace {

// Unit vector of least cost (smallest eigenvector of the information), with the sign on the side of
// `above`.
Eigen::Vector3d LowestCostUp(const Eigen::Matrix3d& information, const Eigen::Vector3d& above) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(information);
  const Eigen::Vector3d up = eigen.eigenvectors().col(0);
  return up.dot(above) < 0.0 ? -up : up;
}

// Search of up before boxes are used: steps, and initial guesses, farther apart than neighbours of
// the grid.
constexpr double kTiltStep = 7.5 * kRadPerDeg;
constexpr size_t kStarts = 4;
constexpr double kBetweenStarts = 1.6 * kTiltStep;
constexpr double kYawStepOfSearch = 6.0 * kRadPerDeg;

constexpr double kBound = 3.0;         // standard deviations
constexpr double kUnitOfHeight = 0.1;  // length of weight 1, as a share of the image's height
constexpr int kUpSteps = 32;           // of the search, in either direction
constexpr int kMaxUpRounds = 50;
constexpr double kUpTolerance = 1e-9;  // rad

// A direction that is level, if it is what it is taken for.
struct LevelDirection {
  Eigen::Vector3d in_world;
  double sigma;  // of its angle to the horizontal (rad)
  double share;  // how many independent ones it counts as
};

// Geman-McClure loss of up over level directions: those that are off by more than kBound standard
// deviations are something else, and have little influence.
class LevelDirections {
 public:
  explicit LevelDirections(std::vector<LevelDirection> directions)
      : directions_(std::move(directions)) {}

  double Cost(const Eigen::Vector3d& up) const {
    double cost = 0.0;
    for (const LevelDirection& one : directions_) {
      cost += one.share * EvaluateLoss(loss_, one.in_world.dot(up) / one.sigma).cost;
    }
    return cost;
  }

  // Information with the loss's IRLS weights at `up`.
  Eigen::Matrix3d Information(const Eigen::Vector3d& up) const {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    for (const LevelDirection& one : directions_) {
      const double robust = EvaluateLoss(loss_, one.in_world.dot(up) / one.sigma).weight;
      information +=
          robust * one.share / (one.sigma * one.sigma) * one.in_world * one.in_world.transpose();
    }
    return information;
  }

  // Descends from `up` with another information added.
  UpPrior Descend(const Eigen::Matrix3d& added, const Eigen::Vector3d& up) const {
    UpPrior prior{added, up};
    for (int round = 0; round < kMaxUpRounds; ++round) {
      const Eigen::Vector3d before = prior.up_in_world;
      prior.information = added + Information(before);
      prior.up_in_world = LowestCostUp(prior.information, before);
      if ((prior.up_in_world - before).norm() < kUpTolerance) break;
    }
    return prior;
  }

 private:
  std::vector<LevelDirection> directions_;
  GemanMcClureLoss loss_{kBound};
};

// Planes through cameras' centres and segments; their normals are level where the edges are
// vertical.
LevelDirections ComputeNormals(const std::vector<SegmentView>& views, double sigma,
                               double correlation_rad) {
  const std::vector<double> shares = CameraWeights(PosesOf(views), correlation_rad);
  std::vector<LevelDirection> normals;
  for (size_t i = 0; i < views.size(); ++i) {
    const Camera& camera = views[i].camera;
    for (const LineSegment& segment : views[i].segments) {
      const Eigen::Vector3d normal = camera.Ray(segment.begin).cross(camera.Ray(segment.end));
      const double length = (segment.end - segment.begin).norm();
      const double count = length / (kUnitOfHeight * camera.height);
      normals.push_back(
          {views[i].world_from_camera.rotation * normal.normalized(), sigma, shares[i] * count});
    }
  }
  return LevelDirections(std::move(normals));
}

// The axes of all cameras that are level when they are held so.
LevelDirections AxesOfCameras(const std::vector<Rigid3d>& world_from_camera, const CameraTilt& tilt,
                              double correlation_rad, CameraOrientation orientation) {
  const OrientationAxes held = AxesOf(orientation);
  const std::vector<double> shares = CameraWeights(world_from_camera, correlation_rad);
  std::vector<LevelDirection> axes;
  for (size_t i = 0; i < shares.size(); ++i) {
    const Eigen::Quaterniond& rotation = world_from_camera[i].rotation;
    axes.push_back({rotation * held.level, tilt.RollSigma(), shares[i]});
    axes.push_back({rotation * held.up.cross(held.level), tilt.PitchSigma(), shares[i]});
  }
  return LevelDirections(std::move(axes));
}

// Sum of the directions that are up in each camera.
Eigen::Vector3d AboveCameras(const std::vector<Rigid3d>& world_from_camera,
                             CameraOrientation orientation) {
  Eigen::Vector3d above = Eigen::Vector3d::Zero();
  for (const Rigid3d& pose : world_from_camera) above += pose.rotation * AxesOf(orientation).up;
  return above;
}

}  // namespace

UpPrior UpPriorFromCameras(const std::vector<Rigid3d>& world_from_camera, const CameraTilt& tilt,
                           double correlation_rad, CameraOrientation orientation) {
  const Eigen::Matrix3d information =
      AxesOfCameras(world_from_camera, tilt, correlation_rad, orientation)
          .Information(Eigen::Vector3d::Zero());
  return {information, LowestCostUp(information, AboveCameras(world_from_camera, orientation))};
}

UpPrior RobustUpPriorFromCameras(const std::vector<Rigid3d>& world_from_camera,
                                 const CameraTilt& tilt, double correlation_rad,
                                 CameraOrientation orientation) {
  const LevelDirections axes = AxesOfCameras(world_from_camera, tilt, correlation_rad, orientation);
  // Directions of a half of the sphere, about three degrees apart.
  constexpr int kDirections = 2400;
  constexpr double kGoldenAngle = 2.399963229728653;
  std::vector<Eigen::Vector3d> half;
  for (int i = 0; i < kDirections; ++i) {
    const double z = (i + 0.5) / kDirections;
    const double radius = std::sqrt(1.0 - z * z);
    half.emplace_back(radius * std::cos(i * kGoldenAngle), radius * std::sin(i * kGoldenAngle), z);
  }
  Eigen::Vector3d lowest =
      *std::ranges::min_element(half, {}, [&](const Eigen::Vector3d& up) { return axes.Cost(up); });
  if (lowest.dot(AboveCameras(world_from_camera, orientation)) < 0.0) lowest = -lowest;
  UpPrior prior = axes.Descend(Eigen::Matrix3d::Zero(), lowest);
  const std::vector<double> shares = CameraWeights(world_from_camera, correlation_rad);
  const double count = std::accumulate(shares.begin(), shares.end(), 0.0);
  prior.information /= std::max(1.0, axes.Cost(prior.up_in_world) / count);
  return prior;
}

Eigen::Matrix3d InformationOfVerticals(const SegmentView& view, double sigma,
                                       const Eigen::Vector3d& up_in_world) {
  return ComputeNormals({view}, sigma, 0.0).Information(up_in_world);
}

UpPrior WithVerticals(const UpPrior& up_prior, const std::vector<SegmentView>& views, double sigma,
                      double correlation_rad, double max_tilt) {
  const LevelDirections normals = ComputeNormals(views, sigma, correlation_rad);
  const auto cost = [&](const Eigen::Vector3d& up) { return up_prior.Cost(up) + normals.Cost(up); };
  Eigen::Vector3d best = up_prior.up_in_world;
  double lowest = cost(best);
  const Eigen::Quaterniond level = UprightRotation(up_prior.up_in_world, 0.0);
  for (int i = -kUpSteps; i <= kUpSteps; ++i) {
    for (int k = -kUpSteps; k <= kUpSteps; ++k) {
      const Eigen::Vector3d turn = Eigen::Vector3d(i, k, 0.0) * (max_tilt / kUpSteps);
      const Eigen::Vector3d up = ExpRotation(level * turn) * up_prior.up_in_world;
      if (cost(up) >= lowest) continue;
      lowest = cost(up);
      best = up;
    }
  }
  return normals.Descend(up_prior.information, best);
}

std::vector<Eigen::Vector3d> UpDirections(const UpPrior& prior, double step) {
  constexpr double kMaxSigmas = 2.5;
  constexpr double kMaxTilt = 45.0 * kRadPerDeg;
  const Eigen::Quaterniond level = UprightRotation(prior.up_in_world, 0.0);
  const double lowest = prior.Cost(prior.up_in_world);
  const int steps = static_cast<int>(kMaxTilt / step);
  std::vector<Eigen::Vector3d> directions = {prior.up_in_world};
  for (int i = -steps; i <= steps; ++i) {
    for (int k = -steps; k <= steps; ++k) {
      const Eigen::Vector3d turn(i * step, k * step, 0.0);
      if ((i == 0 && k == 0) || turn.norm() > kMaxTilt) continue;
      const Eigen::Vector3d up = ExpRotation(level * turn) * prior.up_in_world;
      if (2.0 * (prior.Cost(up) - lowest) > kMaxSigmas * kMaxSigmas) continue;
      directions.push_back(up);
    }
  }
  return directions;
}

std::vector<Eigen::Vector3d> LowestApart(const std::vector<Eigen::Vector3d>& directions,
                                         const std::vector<double>& costs, double min_angle,
                                         size_t count) {
  std::vector<size_t> order(directions.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::ranges::stable_sort(order, {}, [&](size_t i) { return costs[i]; });
  std::vector<Eigen::Vector3d> lowest;
  for (const size_t i : order) {
    const bool is_apart = std::ranges::all_of(lowest, [&](const Eigen::Vector3d& other) {
      return AngleBetween(other, directions[i]) > min_angle;
    });
    if (is_apart) lowest.push_back(directions[i]);
    if (lowest.size() == count) break;
  }
  return lowest;
}

std::optional<double> CostOfUprightBody(const Eigen::Vector3d& up_in_world,
                                        ObjectEvidence observation) {
  observation.plane = {up_in_world, 0.0};
  std::optional<double> lowest;
  for (const auto& fit : ProfileOverYaw(observation, kYawStepOfSearch).fits) {
    if (fit && !(lowest && *lowest <= fit->cost.total)) lowest = fit->cost.total;
  }
  return lowest;
}

std::vector<Eigen::Vector3d> SearchUp(
    const UpPrior& up_prior, const std::vector<std::optional<ObjectEvidence>>& observations,
    int threads) {
  const std::vector<Eigen::Vector3d> candidates = UpDirections(up_prior, kTiltStep);
  std::vector<double> costs(candidates.size());
  ParallelFor("directions of up", candidates.size(), threads, [&](size_t i) {
    const Eigen::Vector3d& up = candidates[i];
    costs[i] = up_prior.Cost(up);
    for (const auto& observation : observations) {
      if (observation) costs[i] += CostOfUprightBody(up, *observation).value_or(kCostWithoutBody);
    }
  });
  return LowestApart(candidates, costs, kBetweenStarts, kStarts);
}

std::vector<Rigid3d> PosesOf(const std::vector<SegmentView>& views) {
  std::vector<Rigid3d> poses;
  for (const SegmentView& view : views) poses.push_back(view.world_from_camera);
  return poses;
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "planes/up_prior.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/parallel.h"
#include "constraints/loss.h"
#include "geometry/angles.h"
#include "geometry/direction_weights.h"
#include "geometry/landmark.h"

namespace soslam {

Eigen::Vector3d LowestCostUp(const Eigen::Matrix3d& information, const Eigen::Vector3d& above) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(information);
  const Eigen::Vector3d up = eigen.eigenvectors().col(0);
  return up.dot(above) < 0.0 ? -up : up;
}

std::vector<double> CameraWeights(const std::vector<Rigid3d>& world_from_camera,
                                  double correlation_rad) {
  std::vector<Eigen::Vector3d> optical_axes;
  for (const Rigid3d& pose : world_from_camera) {
    optical_axes.emplace_back(pose.rotation * Eigen::Vector3d::UnitZ());
  }
  return DirectionWeights(optical_axes, correlation_rad);
}

UpPrior UpPriorFromCameras(const std::vector<Rigid3d>& world_from_camera, double roll_sigma,
                           double pitch_sigma, double correlation_rad, CameraHolding holding) {
  const HeldAxes held = AxesOf(holding);
  UpPrior attitude;
  Eigen::Vector3d above = Eigen::Vector3d::Zero();
  const std::vector<double> shares = CameraWeights(world_from_camera, correlation_rad);
  for (size_t i = 0; i < shares.size(); ++i) {
    const Eigen::Matrix3d rotation = world_from_camera[i].rotation.toRotationMatrix();
    const Eigen::Vector3d level = rotation * held.level;
    const Eigen::Vector3d third = rotation * held.up.cross(held.level);
    attitude.information += shares[i] * (level * level.transpose() / (roll_sigma * roll_sigma) +
                                         third * third.transpose() / (pitch_sigma * pitch_sigma));
    above += rotation * held.up;
  }
  attitude.up_in_world = LowestCostUp(attitude.information, above);
  return attitude;
}

namespace {

constexpr double kBound = 3.0;         // standard deviations
constexpr double kUnitOfHeight = 0.1;  // length of weight 1, as a share of the image's height
constexpr int kUpSteps = 32;           // of the search, in either direction
constexpr int kMaxUpRounds = 50;
constexpr double kUpTolerance = 1e-9;  // rad

// Plane through a camera's centre and a segment.
struct SegmentPlane {
  Eigen::Vector3d normal_in_world;
  double weight;  // already divided by the variance of the angle to up (1 / rad^2)
};

std::vector<SegmentPlane> PlanesOf(const std::vector<SegmentView>& views, double sigma,
                                   double correlation_rad) {
  std::vector<Rigid3d> poses;
  for (const SegmentView& view : views) poses.push_back(view.world_from_camera);
  const std::vector<double> shares = CameraWeights(poses, correlation_rad);
  std::vector<SegmentPlane> planes;
  for (size_t i = 0; i < views.size(); ++i) {
    const Camera& camera = views[i].camera;
    for (const LineSegment& segment : views[i].segments) {
      const Eigen::Vector3d normal = camera.Ray(segment.begin).cross(camera.Ray(segment.end));
      const double length = (segment.end - segment.begin).norm();
      const double count = length / (kUnitOfHeight * camera.height);
      planes.push_back({views[i].world_from_camera.rotation * normal.normalized(),
                        shares[i] * count / (sigma * sigma)});
    }
  }
  return planes;
}

// Geman-McClure loss of the angle between up and the segments' planes.
class Verticals {
 public:
  Verticals(std::vector<SegmentPlane> planes, double sigma)
      : planes_(std::move(planes)), loss_(kBound * sigma) {}

  double Cost(const Eigen::Vector3d& up) const {
    double cost = 0.0;
    for (const SegmentPlane& plane : planes_) {
      cost += plane.weight * EvaluateLoss(loss_, plane.normal_in_world.dot(up)).cost;
    }
    return cost;
  }

  // Information with the loss's IRLS weights at `up`.
  Eigen::Matrix3d Information(const Eigen::Vector3d& up) const {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    for (const SegmentPlane& plane : planes_) {
      const double robust = EvaluateLoss(loss_, plane.normal_in_world.dot(up)).weight;
      information +=
          robust * plane.weight * plane.normal_in_world * plane.normal_in_world.transpose();
    }
    return information;
  }

 private:
  std::vector<SegmentPlane> planes_;
  GemanMcClureLoss loss_;  // rad
};

}  // namespace

Eigen::Matrix3d InformationOfVerticals(const SegmentView& view, double sigma,
                                       const Eigen::Vector3d& up_in_world) {
  return Verticals(PlanesOf({view}, sigma, 0.0), sigma).Information(up_in_world);
}

UpPrior WithVerticals(const UpPrior& attitude, const std::vector<SegmentView>& views, double sigma,
                      double correlation_rad, double max_tilt) {
  const Verticals verticals(PlanesOf(views, sigma, correlation_rad), sigma);
  const auto cost = [&](const Eigen::Vector3d& up) {
    return 0.5 * up.dot(attitude.information * up) + verticals.Cost(up);
  };
  UpPrior best = attitude;
  double lowest = cost(attitude.up_in_world);
  const Eigen::Quaterniond level = UprightRotation(attitude.up_in_world, 0.0);
  for (int i = -kUpSteps; i <= kUpSteps; ++i) {
    for (int k = -kUpSteps; k <= kUpSteps; ++k) {
      const Eigen::Vector3d turn = Eigen::Vector3d(i, k, 0.0) * (max_tilt / kUpSteps);
      const Eigen::Vector3d up = ExpRotation(level * turn) * attitude.up_in_world;
      if (cost(up) >= lowest) continue;
      lowest = cost(up);
      best.up_in_world = up;
    }
  }
  for (int round = 0; round < kMaxUpRounds; ++round) {
    const Eigen::Vector3d before = best.up_in_world;
    best.information = attitude.information + verticals.Information(before);
    best.up_in_world = LowestCostUp(best.information, before);
    if ((best.up_in_world - before).norm() < kUpTolerance) break;
  }
  return best;
}

namespace {

// Search range of up before boxes are used: this many standard deviations from the cameras' up.
constexpr double kMaxSigmas = 2.5;
constexpr double kMaxTiltOfCameras = 45.0 * kRadPerDeg;
constexpr double kTiltStep = 7.5 * kRadPerDeg;
// Initial guesses of up, farther apart than neighbours of the grid.
constexpr size_t kStarts = 4;
constexpr double kBetweenStarts = 1.6 * kTiltStep;
constexpr double kYawStepOfSearch = 6.0 * kRadPerDeg;

// Directions around the cameras' up, which comes first.
std::vector<Eigen::Vector3d> UpCandidates(const UpPrior& attitude) {
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

double CostOf(const Eigen::Vector3d& up, const UpPrior& attitude,
              const std::vector<std::optional<MultiViewObservation>>& observations) {
  double cost = 0.5 * up.dot(attitude.information * up);
  for (const auto& observation : observations) {
    if (observation) cost += CostOfUprightBody(up, *observation).value_or(kCostWithoutBody);
  }
  return cost;
}

}  // namespace

std::optional<double> CostOfUprightBody(const Eigen::Vector3d& up_in_world,
                                        MultiViewObservation observation) {
  observation.plane_in_world = {up_in_world, 0.0};
  const auto optima = SweepViews(observation, kYawStepOfSearch);
  return optima.empty() ? std::nullopt : std::optional(optima.front().cost);
}

std::vector<Eigen::Vector3d> SearchUp(
    const UpPrior& attitude, const std::vector<std::optional<MultiViewObservation>>& observations,
    int threads) {
  const std::vector<Eigen::Vector3d> candidates = UpCandidates(attitude);
  std::vector<double> costs(candidates.size());
  ParallelFor("directions of up", static_cast<int>(candidates.size()), threads, [&](int i) {
    const auto index = static_cast<size_t>(i);
    costs[index] = CostOf(candidates[index], attitude, observations);
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

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "planes/verticals.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>

#include "geometry/landmark.h"

namespace soslam {
namespace {

constexpr double kBound = 3.0;         // standard deviations
constexpr double kUnitOfHeight = 0.1;  // length of weight 1, as a share of the image's height
constexpr int kTiltSteps = 32;         // of the search, in either direction
constexpr int kMaxRounds = 50;
constexpr double kSettled = 1e-9;  // rad

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
      : planes_(std::move(planes)), bound_(kBound * kBound * sigma * sigma) {}

  double Cost(const Eigen::Vector3d& up) const {
    double cost = 0.0;
    for (const SegmentPlane& plane : planes_) {
      const double square = std::pow(plane.normal_in_world.dot(up), 2);
      cost += 0.5 * plane.weight * square * bound_ / (bound_ + square);
    }
    return cost;
  }

  // Information with the loss's IRLS weights at `up`.
  Eigen::Matrix3d Information(const Eigen::Vector3d& up) const {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    for (const SegmentPlane& plane : planes_) {
      const double square = std::pow(plane.normal_in_world.dot(up), 2);
      const double robust = std::pow(bound_ / (bound_ + square), 2);
      information +=
          robust * plane.weight * plane.normal_in_world * plane.normal_in_world.transpose();
    }
    return information;
  }

 private:
  std::vector<SegmentPlane> planes_;
  double bound_;
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
  for (int i = -kTiltSteps; i <= kTiltSteps; ++i) {
    for (int k = -kTiltSteps; k <= kTiltSteps; ++k) {
      const Eigen::Vector3d turn = Eigen::Vector3d(i, k, 0.0) * (max_tilt / kTiltSteps);
      const Eigen::Vector3d up = ExpRotation(level * turn) * attitude.up_in_world;
      if (cost(up) >= lowest) continue;
      lowest = cost(up);
      best.up_in_world = up;
    }
  }
  for (int round = 0; round < kMaxRounds; ++round) {
    const Eigen::Vector3d before = best.up_in_world;
    best.information = attitude.information + verticals.Information(before);
    best.up_in_world = LowestCostUp(best.information, before);
    if ((best.up_in_world - before).norm() < kSettled) break;
  }
  return best;
}

}  // namespace soslam

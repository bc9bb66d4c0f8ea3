// SPDX-License-Identifier: BSD-3-Clause
#include "ground/horizontal_planes.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "constraints/loss.h"
#include "geometry/angles.h"
#include "geometry/triangulation.h"

namespace soslam {
namespace {

// Error of a point's depth that all its views share, as a fraction.
constexpr double kDepthError = 1e-3;

std::optional<GroundPoint> GroundPointOf(const Sequence& sequence, const MapPoint& point) {
  GroundPoint result{point.position_in_world, Eigen::Matrix3d::Zero(), {}};
  const double sigma_px = std::max(kLeastPixelSigma, point.reprojection_error_px);
  std::vector<PointView> views;
  double nearest = std::numeric_limits<double>::infinity();
  for (const PointObservation& observation : point.observations) {
    const auto index = FrameIndexOf(sequence, observation);
    if (!index) continue;
    const Frame& frame = sequence.frames[*index];
    views.push_back(
        {sequence.CameraOf(frame), frame.world_from_camera.Inverse(), observation.pixel});
    const double depth_m = (views.back().camera_from_world * point.position_in_world).z();
    if (!(depth_m > 0.0)) return std::nullopt;
    nearest = std::min(nearest, depth_m);
    result.frame_indices.push_back(static_cast<int>(*index));
  }
  if (result.frame_indices.size() < 2) return std::nullopt;
  result.covariance =
      sigma_px * sigma_px * PointInformation(views, point.position_in_world).inverse();
  result.covariance.diagonal().array() += kDepthError * kDepthError * nearest * nearest;
  return result.covariance.allFinite() ? std::optional(std::move(result)) : std::nullopt;
}

// Lengths have the typical distance of the points from the cameras as their unit.
constexpr double kMaxPointSigma = 0.01;  // of points that are used
constexpr double kRoughness = 0.0015;    // deviation of surfaces from planes
constexpr double kBin = 0.008;           // of the search over up
constexpr double kTiltStep = 1.0 * kRadPerDeg;
constexpr double kBetweenStarts = 1.2 * kTiltStep;
constexpr size_t kStarts = 16;  // directions that are refined
constexpr double kBound = 3.0;  // inliers, standard deviations
constexpr int kRounds = 10;
constexpr size_t kMaxPlanes = 12;
constexpr double kLeastShare = 0.01;  // of the points, on a plane
constexpr double kLeastOnPlane = 15.0;
constexpr double kLeastContrast = 2.0;  // of the density on a plane, relative to its surroundings
constexpr double kLyingThings = 0.2 * kRadPerDeg;  // error of a tilt by flat things on a plane
constexpr double kCommonHeight = 0.002;            // error of a height that all points share
constexpr size_t kSectors = 8;                     // parts of the planes whose scatter is measured

// Standard deviation of a point's height.
double Sigma(const GroundPoint& point, const Eigen::Vector3d& up) {
  return std::hypot(std::sqrt(up.dot(point.covariance * up)), kRoughness);
}

std::vector<GroundPoint> UsablePoints(std::vector<GroundPoint> points, const Eigen::Vector3d& up) {
  std::erase_if(points, [&](const GroundPoint& point) {
    return up.dot(point.covariance * up) > kMaxPointSigma * kMaxPointSigma;
  });
  return points;
}

// Number of pairs of points at the same height.
double Sharpness(const std::vector<GroundPoint>& points, const Eigen::Vector3d& up) {
  constexpr double kReach = 10.0;  // farther points are in the outermost bins
  std::vector<double> bins(static_cast<size_t>(2.0 * kReach / kBin) + 2);
  for (const GroundPoint& point : points) {
    const double height = std::clamp(up.dot(point.position_in_world), -kReach, kReach);
    const double position = (height + kReach) / kBin;
    const auto bin = static_cast<size_t>(position);
    const double share = position - std::floor(position);
    bins[bin] += 1.0 - share;
    bins[bin + 1] += share;
  }
  double sum = 0.0;
  for (const double count : bins) sum += count * count;
  return sum;
}

struct HeightReading {
  double height;
  double sigma;

  bool IsWithin(double sigmas, double other) const {
    return std::abs(height - other) < sigmas * sigma;
  }
};

double CountNear(const std::vector<HeightReading>& readings, double height, double sigmas) {
  return static_cast<double>(std::ranges::count_if(
      readings, [&](const HeightReading& reading) { return reading.IsWithin(sigmas, height); }));
}

// Heights at which points lie much denser than around, most points first.
std::vector<double> PeakHeights(const std::vector<GroundPoint>& points, const Eigen::Vector3d& up) {
  std::vector<HeightReading> all;
  for (const GroundPoint& point : points) {
    all.push_back({up.dot(point.position_in_world), Sigma(point, up)});
  }
  std::vector<HeightReading> readings = all;
  const double least = std::max(kLeastOnPlane, kLeastShare * static_cast<double>(points.size()));
  std::vector<double> peaks;
  while (peaks.size() < kMaxPlanes) {
    // The height to which most readings are near.
    constexpr double kNear = 1.5;  // standard deviations
    std::vector<std::pair<double, int>> ends;
    for (const HeightReading& reading : readings) {
      ends.emplace_back(reading.height - kNear * reading.sigma, 1);
      ends.emplace_back(reading.height + kNear * reading.sigma, -1);
    }
    std::ranges::sort(ends);
    int near = 0, most = 0;
    double height = 0.0;
    for (size_t i = 0; i < ends.size(); ++i) {
      near += ends[i].second;
      if (near <= most) continue;
      most = near;
      height = 0.5 * (ends[i].first + ends[i + 1].first);
    }
    const double count = CountNear(readings, height, kBound);
    if (count < least) break;
    // Where points are evenly distributed, twice the width has twice as many.
    const double around = CountNear(all, height, 2.0 * kBound) - CountNear(all, height, kBound);
    if (count > kLeastContrast * around) peaks.push_back(height);
    std::erase_if(readings,
                  [&](const HeightReading& reading) { return reading.IsWithin(kBound, height); });
  }
  return peaks;
}

// Up and the heights of all planes, which points fit best.
struct Fit {
  Eigen::Vector3d up;
  std::vector<double> heights;
  Eigen::MatrixXd covariance;  // of two rotations (rad) and the heights
  double gain = 0.0;           // how much better points lie on planes than anywhere
};

// The plane of a point, or none where it is off all of them.
std::optional<size_t> PlaneOfPoint(const Fit& fit, const GroundPoint& point, double sigma) {
  std::optional<size_t> best;
  double nearest = kBound * sigma;
  for (size_t k = 0; k < fit.heights.size(); ++k) {
    const double distance = std::abs(fit.up.dot(point.position_in_world) - fit.heights[k]);
    if (distance >= nearest) continue;
    nearest = distance;
    best = k;
  }
  return best;
}

// One step of reweighted least squares.
void Step(const std::vector<GroundPoint>& points, const UpPrior& up_prior, Fit* fit) {
  const auto count = static_cast<Eigen::Index>(2 + fit->heights.size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(count, count);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(count);
  const Eigen::Matrix<double, 3, 2> d_turns = UpByTurns(fit->up);
  information.topLeftCorner<2, 2>() = d_turns.transpose() * up_prior.information * d_turns;
  gradient.head<2>() = d_turns.transpose() * up_prior.information * fit->up;
  const GemanMcClureLoss loss(kBound);
  fit->gain = -0.5 * fit->up.dot(up_prior.information * fit->up);
  for (const GroundPoint& point : points) {
    const double sigma = Sigma(point, fit->up);
    const auto plane = PlaneOfPoint(*fit, point, sigma);
    if (!plane) continue;
    const double residual = (fit->up.dot(point.position_in_world) - fit->heights[*plane]) / sigma;
    const double weight = EvaluateLoss(loss, residual).weight;
    // The row of the Jacobian, which is zero for the other planes.
    Eigen::Vector3d row;
    row << d_turns.transpose() * point.position_in_world / sigma, -1.0 / sigma;
    const std::array<Eigen::Index, 3> at = {0, 1, static_cast<Eigen::Index>(2 + *plane)};
    gradient(at) += weight * residual * row;
    information(at, at) += weight * row * row.transpose();
    fit->gain += 0.5 * (kBound * kBound - residual * residual);
  }
  information.diagonal().tail(count - 2).array() += 1e-9;
  const Eigen::LDLT<Eigen::MatrixXd> solver(information);
  const Eigen::VectorXd change = -solver.solve(gradient);
  fit->up = (fit->up + d_turns * change.head<2>()).normalized();
  for (size_t k = 0; k < fit->heights.size(); ++k) {
    fit->heights[k] += change(static_cast<Eigen::Index>(2 + k));
  }
  fit->covariance = solver.solve(Eigen::MatrixXd::Identity(count, count));
}

Fit FitPlanes(const std::vector<GroundPoint>& points, const UpPrior& up_prior, Eigen::Vector3d up,
              std::vector<double> heights) {
  Fit fit{std::move(up), std::move(heights), {}, 0.0};
  for (int round = 0; round < kRounds; ++round) Step(points, up_prior, &fit);
  return fit;
}

// The points on planes, in as many sectors around their common centre as are left out in turn.
std::vector<std::vector<GroundPoint>> WithoutSectors(const std::vector<GroundPoint>& points,
                                                     const Fit& fit) {
  std::vector<GroundPoint> inliers;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const GroundPoint& point : points) {
    if (!PlaneOfPoint(fit, point, Sigma(point, fit.up))) continue;
    inliers.push_back(point);
    centre += point.position_in_world;
  }
  centre /= static_cast<double>(std::max<size_t>(1, inliers.size()));
  const Eigen::Matrix3d level = UprightRotation(fit.up, 0.0).toRotationMatrix();
  std::vector<std::vector<GroundPoint>> others(kSectors);
  for (const GroundPoint& point : inliers) {
    const Eigen::Vector3d from_centre = level.transpose() * (point.position_in_world - centre);
    const double turns = std::atan2(from_centre.y(), from_centre.x()) / (2.0 * std::numbers::pi);
    const auto own = static_cast<size_t>((turns + 0.5) * static_cast<double>(kSectors)) % kSectors;
    for (size_t sector = 0; sector < kSectors; ++sector) {
      if (sector != own) others[sector].push_back(point);
    }
  }
  return others;
}

HorizontalPlanes PlanesOf(const std::vector<GroundPoint>& points, const UpPrior& up_prior,
                          const Fit& fit, const Eigen::Matrix2d& ambiguity) {
  HorizontalPlanes result;
  result.ambiguity = ambiguity;
  result.up_in_world = fit.up;
  result.planes.resize(fit.heights.size());
  for (const GroundPoint& point : points) {
    const auto index = PlaneOfPoint(fit, point, Sigma(point, fit.up));
    if (!index) continue;
    PlaneOfPoints& plane = result.planes[*index];
    plane.points_in_world.push_back(point.position_in_world);
    plane.centre_in_world += (point.position_in_world - plane.centre_in_world) /
                             static_cast<double>(plane.points_in_world.size());
  }
  const Eigen::Matrix3d level = UprightRotation(fit.up, 0.0).toRotationMatrix();
  for (size_t k = 0; k < fit.heights.size(); ++k) {
    PlaneOfPoints& plane = result.planes[k];
    plane.height = fit.heights[k];
    Eigen::MatrixXd d_fit = Eigen::MatrixXd::Zero(3, fit.covariance.cols());
    d_fit.topLeftCorner<2, 2>().setIdentity();
    d_fit.row(2).head<2>() << level.col(1).dot(plane.centre_in_world),
        -level.col(0).dot(plane.centre_in_world);
    d_fit(2, static_cast<Eigen::Index>(2 + k)) = 1.0;
    plane.covariance = d_fit * fit.covariance * d_fit.transpose();
  }
  // The scatter of fits that leave out one sector each (delete-a-block jackknife).
  constexpr double kShare = (kSectors - 1.0) / kSectors;
  for (const auto& others : WithoutSectors(points, fit)) {
    const Fit without = FitPlanes(others, up_prior, fit.up, fit.heights);
    const Eigen::Vector3d turn = without.up - fit.up;
    for (size_t k = 0; k < result.planes.size(); ++k) {
      PlaneOfPoints& plane = result.planes[k];
      const Eigen::Vector3d change(
          -level.col(1).dot(turn), level.col(0).dot(turn),
          without.heights[k] - fit.heights[k] - turn.dot(plane.centre_in_world));
      plane.covariance += kShare * change * change.transpose();
    }
  }
  for (PlaneOfPoints& plane : result.planes) {
    plane.covariance.diagonal().head<2>().array() += kLyingThings * kLyingThings;
    plane.covariance(2, 2) += kCommonHeight * kCommonHeight;
    plane.covariance.topLeftCorner<2, 2>() += ambiguity;
  }
  result.tilt_covariance = result.planes.front().covariance.topLeftCorner<2, 2>();
  std::ranges::sort(result.planes, {}, &PlaneOfPoints::height);
  return result;
}

// Mean squared turn from the best direction to others whose planes explain nearly as many points.
Eigen::Matrix2d AmbiguityOf(std::vector<Fit> fits, const Fit& best) {
  constexpr double kShare =
      0.1;  // of the gain; as much less makes a direction e times less probable
  constexpr double kSameUp = 0.3 * kRadPerDeg;
  std::ranges::stable_sort(fits, std::ranges::greater(), &Fit::gain);
  std::vector<Eigen::Vector3d> seen;
  const Eigen::Matrix3d level = UprightRotation(best.up, 0.0).toRotationMatrix();
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  double sum = 0.0;
  for (const Fit& fit : fits) {
    const bool is_new = std::ranges::all_of(
        seen, [&](const Eigen::Vector3d& other) { return AngleBetween(other, fit.up) > kSameUp; });
    if (!is_new) continue;
    seen.push_back(fit.up);
    const double weight = std::exp((fit.gain - best.gain) / (kShare * std::max(1.0, best.gain)));
    const Eigen::Vector2d turn(-level.col(1).dot(fit.up), level.col(0).dot(fit.up));
    squares += weight * turn * turn.transpose();
    sum += weight;
  }
  return squares / sum;
}

HorizontalPlanes WithoutPlanes(const UpPrior& up_prior) {
  HorizontalPlanes result;
  result.up_in_world = up_prior.up_in_world;
  result.tilt_covariance = TiltCovariance(up_prior);
  return result;
}

}  // namespace

std::vector<GroundPoint> GroundPoints(const Sequence& sequence,
                                      const std::vector<MapPoint>& points) {
  std::vector<GroundPoint> result;
  for (const MapPoint& point : points) {
    if (auto one = GroundPointOf(sequence, point)) result.push_back(std::move(*one));
  }
  return result;
}

HorizontalPlanes FindHorizontalPlanes(const std::vector<GroundPoint>& points,
                                      const UpPrior& up_prior) {
  const std::vector<GroundPoint> usable = UsablePoints(points, up_prior.up_in_world);
  const double lowest = up_prior.up_in_world.dot(up_prior.information * up_prior.up_in_world);
  const std::vector<Eigen::Vector3d> directions = UpDirections(up_prior, kTiltStep);
  std::vector<double> costs;
  for (const Eigen::Vector3d& up : directions) {
    const double cost = up.dot(up_prior.information * up) - lowest;
    costs.push_back(-Sharpness(usable, up) * std::exp(-0.25 * cost));
  }
  std::vector<Fit> fits;
  for (const Eigen::Vector3d& start : LowestApart(directions, costs, kBetweenStarts, kStarts)) {
    Eigen::Vector3d up = start;
    for (int round = 0; round < 2; ++round) {
      const std::vector<double> heights = PeakHeights(usable, up);
      if (heights.empty()) break;
      fits.push_back(FitPlanes(usable, up_prior, up, heights));
      up = fits.back().up;
    }
  }
  if (fits.empty()) return WithoutPlanes(up_prior);
  const Fit& best = *std::ranges::max_element(fits, {}, &Fit::gain);
  const Eigen::Matrix2d ambiguity = AmbiguityOf(fits, best);
  return PlanesOf(usable, up_prior, best, ambiguity);
}

void AddAmbiguity(double variance, HorizontalPlanes* planes) {
  const Eigen::Matrix2d covariance = 0.5 * variance * Eigen::Matrix2d::Identity();
  planes->ambiguity += covariance;
  planes->tilt_covariance += covariance;
  for (PlaneOfPoints& plane : planes->planes) {
    plane.covariance.topLeftCorner<2, 2>() += covariance;
  }
}

HorizontalPlanes Refined(const HorizontalPlanes& planes, const std::vector<GroundPoint>& points,
                         const UpPrior& up_prior) {
  if (planes.planes.empty()) return WithoutPlanes(up_prior);
  std::vector<double> heights;
  for (const PlaneOfPoints& plane : planes.planes) heights.push_back(plane.height);
  const std::vector<GroundPoint> usable = UsablePoints(points, planes.up_in_world);
  return PlanesOf(usable, up_prior, FitPlanes(usable, up_prior, planes.up_in_world, heights),
                  planes.ambiguity);
}

}  // namespace soslam

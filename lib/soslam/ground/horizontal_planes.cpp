// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/ground/horizontal_planes.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "soslam/geometry/angles.h"
#include "soslam/geometry/triangulation.h"

namespace soslam {
namespace {

// Error of a point's depth that all its views share, as a fraction.
constexpr double kDepthError = 1e-3;

std::optional<GroundPoint> MeasureGroundPoint(const Sequence& sequence, const MapPoint& point) {
  GroundPoint result{point.position_in_world, Eigen::Matrix3d::Zero(), {}};
  const double sigma_px = std::max(kLeastPixelSigma, point.reprojection_error_px);
  std::vector<PointView> views;
  double nearest = std::numeric_limits<double>::infinity();
  for (const PointObservation& observation : point.observations) {
    const auto index = FindFrameIndex(sequence, observation);
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
constexpr double kLeastOffPlanes = 0.01;  // share of the points
constexpr double kRange = 1.0;            // of heights of points that are on no plane (a guess)
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
double CountPairsAtSameHeight(const std::vector<GroundPoint>& points, const Eigen::Vector3d& up) {
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

// Up and the heights of all planes, which points fit best. The height of a point is normally
// distributed about that of the nearest plane, or uniformly over kRange where it is on none.
struct Fit {
  Eigen::Vector3d up;
  std::vector<double> heights;
  std::vector<double> shares = {};  // of the points, on each plane
  Eigen::MatrixXd covariance = {};  // of two rotations (rad) and the heights, were it known which
                                    // points are on planes
  double gain = 0.0;  // log likelihood ratio against points on no plane and up of the prior
};

size_t NearestPlane(const Fit& fit, const GroundPoint& point) {
  const auto distance = [height = fit.up.dot(point.position_in_world)](double other) {
    return std::abs(height - other);
  };
  return std::ranges::min_element(fit.heights, {}, distance) - fit.heights.begin();
}

// One step of expectation maximisation, whose weights are the probabilities to be on the plane.
void Step(const std::vector<GroundPoint>& points, const UpPrior& up_prior, Fit* fit) {
  const auto count = static_cast<Eigen::Index>(2 + fit->heights.size());
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(count, count);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(count);
  const Eigen::Matrix<double, 3, 2> d_turns = UpByTurns(fit->up);
  information.topLeftCorner<2, 2>() = d_turns.transpose() * up_prior.information * d_turns;
  gradient.head<2>() = d_turns.transpose() * up_prior.information * fit->up;
  fit->gain = up_prior.Cost(up_prior.up_in_world) - up_prior.Cost(fit->up);
  const double on_none = 1.0 - std::accumulate(fit->shares.begin(), fit->shares.end(), 0.0);
  std::vector<double> on_planes(fit->shares.size());
  for (const GroundPoint& point : points) {
    const double sigma = Sigma(point, fit->up);
    const size_t plane = NearestPlane(*fit, point);
    const double residual = (fit->up.dot(point.position_in_world) - fit->heights[plane]) / sigma;
    const double density =
        std::exp(-0.5 * residual * residual) / (sigma * std::sqrt(2.0 * std::numbers::pi));
    const double on_plane = fit->shares[plane] * kRange * density;
    const double weight = on_plane / (on_plane + on_none);
    on_planes[plane] += weight;
    // The row of the Jacobian, which is zero for the other planes.
    Eigen::Vector3d row;
    row << d_turns.transpose() * point.position_in_world / sigma, -1.0 / sigma;
    const std::array<Eigen::Index, 3> at = {0, 1, static_cast<Eigen::Index>(2 + plane)};
    gradient(at) += weight * residual * row;
    information(at, at) += weight * row * row.transpose();
    fit->gain += std::log(on_plane + on_none);
  }
  information.diagonal().tail(count - 2).array() += 1e-9;
  const Eigen::LDLT<Eigen::MatrixXd> solver(information);
  const Eigen::VectorXd change = -solver.solve(gradient);
  fit->up = (fit->up + d_turns * change.head<2>()).normalized();
  for (size_t k = 0; k < fit->heights.size(); ++k) {
    fit->heights[k] += change(static_cast<Eigen::Index>(2 + k));
    fit->shares[k] =
        (1.0 - kLeastOffPlanes) * on_planes[k] / std::max(1.0, static_cast<double>(points.size()));
  }
  fit->covariance = solver.solve(Eigen::MatrixXd::Identity(count, count));
}

// Occam's factor of each plane is part of the gain (Laplace's approximation of the evidence,
// heights uniform over kRange and shares over 0 to 1 before points are seen).
Fit FitPlanes(const std::vector<GroundPoint>& points, const UpPrior& up_prior,
              const Eigen::Vector3d& up, const std::vector<double>& heights) {
  Fit fit{up, heights};
  fit.shares.assign(heights.size(), 0.5 / static_cast<double>(heights.size()));
  for (int round = 0; round < kRounds; ++round) Step(points, up_prior, &fit);
  const auto count = static_cast<double>(points.size());
  for (size_t k = 0; k < heights.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(2 + k);
    for (const double variance : {fit.covariance(row, row) / (kRange * kRange),
                                  std::max(fit.shares[k], 1.0 / count) / count}) {
      fit.gain -= 0.5 * std::log1p(1.0 / (2.0 * std::numbers::pi * variance));
    }
  }
  return fit;
}

// The points without those of one sector each, around the centre of those on planes.
std::vector<std::vector<GroundPoint>> WithoutSectors(const std::vector<GroundPoint>& points,
                                                     const Eigen::Vector3d& centre,
                                                     const Eigen::Matrix3d& level) {
  std::vector<std::vector<GroundPoint>> others(kSectors);
  for (const GroundPoint& point : points) {
    const Eigen::Vector3d from_centre = level.transpose() * (point.position_in_world - centre);
    const double turns = std::atan2(from_centre.y(), from_centre.x()) / (2.0 * std::numbers::pi);
    const auto own = static_cast<size_t>((turns + 0.5) * static_cast<double>(kSectors)) % kSectors;
    for (size_t sector = 0; sector < kSectors; ++sector) {
      if (sector != own) others[sector].push_back(point);
    }
  }
  return others;
}

HorizontalPlanes MeasurePlanes(const std::vector<GroundPoint>& points, const UpPrior& up_prior,
                               const Fit& fit, const Eigen::Matrix2d& ambiguity) {
  HorizontalPlanes result;
  result.ambiguity = ambiguity;
  result.up_in_world = fit.up;
  result.gain = fit.gain;
  result.planes.resize(fit.heights.size());
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double on_planes = 0.0;
  for (const GroundPoint& point : points) {
    const size_t index = NearestPlane(fit, point);
    const double distance = fit.up.dot(point.position_in_world) - fit.heights[index];
    if (std::abs(distance) >= kBound * Sigma(point, fit.up)) continue;
    centre += (point.position_in_world - centre) / ++on_planes;
    PlaneOfPoints& plane = result.planes[index];
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
  for (const auto& others : WithoutSectors(points, centre, level)) {
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
    if (auto one = MeasureGroundPoint(sequence, point)) result.push_back(std::move(*one));
  }
  return result;
}

HorizontalPlanes FindHorizontalPlanes(const std::vector<GroundPoint>& points,
                                      const UpPrior& up_prior) {
  const std::vector<GroundPoint> usable = UsablePoints(points, up_prior.up_in_world);
  const double lowest = up_prior.Cost(up_prior.up_in_world);
  const std::vector<Eigen::Vector3d> directions = UpDirections(up_prior, kTiltStep);
  std::vector<double> costs;
  for (const Eigen::Vector3d& up : directions) {
    costs.push_back(-CountPairsAtSameHeight(usable, up) *
                    std::exp(-0.5 * (up_prior.Cost(up) - lowest)));
  }
  std::vector<Fit> fits;
  for (const Eigen::Vector3d& start : LowestApart(directions, costs, kBetweenStarts, kStarts)) {
    Eigen::Vector3d up = start;
    for (int round = 0; round < 2; ++round) {
      const std::vector<double> heights = PeakHeights(usable, up);
      if (heights.empty()) break;
      Fit fit = FitPlanes(usable, up_prior, up, heights);
      // Planes whose points are as probable on no plane are left out.
      while (fit.heights.size() > 1) {
        std::vector<double> others = fit.heights;
        others.erase(others.begin() + (std::ranges::min_element(fit.shares) - fit.shares.begin()));
        Fit without = FitPlanes(usable, up_prior, fit.up, others);
        if (without.gain < fit.gain) break;
        fit = std::move(without);
      }
      up = fit.up;
      fits.push_back(std::move(fit));
    }
  }
  const auto best_fit = std::ranges::max_element(fits, {}, &Fit::gain);
  if (best_fit == fits.end() || best_fit->gain < 0.0) return WithoutPlanes(up_prior);
  const Fit best = *best_fit;
  std::ranges::stable_sort(fits, std::ranges::greater(), &Fit::gain);
  // Ambiguity: mean squared turn from the best direction to others that are nearly as likely.
  constexpr double kSameUp = 0.3 * kRadPerDeg;
  std::vector<Eigen::Vector3d> seen;
  const Eigen::Matrix3d level = UprightRotation(best.up, 0.0).toRotationMatrix();
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  double sum = 0.0;
  for (const Fit& fit : fits) {
    const bool is_new = std::ranges::all_of(
        seen, [&](const Eigen::Vector3d& other) { return AngleBetween(other, fit.up) > kSameUp; });
    if (!is_new) continue;
    seen.push_back(fit.up);
    const double weight = WeightOfGain(fit.gain, best.gain);
    const Eigen::Vector2d turn(-level.col(1).dot(fit.up), level.col(0).dot(fit.up));
    squares += weight * turn * turn.transpose();
    sum += weight;
  }
  return MeasurePlanes(usable, up_prior, best, squares / sum);
}

double WeightOfGain(double gain, double best_gain) {
  constexpr double kShare = 0.1;  // (a guess)
  return std::exp((gain - best_gain) / (kShare * std::max(1.0, best_gain)));
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
  return MeasurePlanes(usable, up_prior, FitPlanes(usable, up_prior, planes.up_in_world, heights),
                       planes.ambiguity);
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/constraints/point_cost.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "soslam/base/upper_median.h"
#include "soslam/constraints/surface_distance.h"

namespace soslam {
namespace {

// Share of an object's points that may lie far inside its label's shape.
constexpr double kRoughShare = 0.6;

// Ends and steps of integrals over the distance.
constexpr double kFarthestSigmas = 5.0;
constexpr double kStepSigmas = 0.125;

double Bell(double x) { return std::exp(-0.5 * x * x); }

// Integral (m) of the density of an object's points over the distance, where it is 1 at the
// surface.
double Width(double sigma_m, double rough_sigma_m) {
  return std::sqrt(0.5 * std::numbers::pi) *
         ((2.0 - kRoughShare) * sigma_m + kRoughShare * rough_sigma_m);
}

}  // namespace

double SizeForPoints(const Landmark& landmark) { return 2.0 * MeanHalfAxis(landmark); }

double SizeForPoints(const std::vector<Landmark>& landmarks) {
  std::vector<double> sizes_m;
  for (const Landmark& landmark : landmarks) sizes_m.push_back(SizeForPoints(landmark));
  return UpperMedian(std::move(sizes_m));
}

PointCost::PointCost(const std::vector<ObjectPoint>& points, const Landmark& start_in_camera,
                     double size_m, const PointOptions& options, double weight,
                     SecondDerivatives second_derivatives)
    : outlier_probability_(options.point_outlier_probability),
      weight_(weight),
      second_derivatives_(second_derivatives) {
  const double sharp_m = options.point_sigma_fraction * size_m;
  const double rough_m = options.point_roughness_fraction * size_m;
  for (const ObjectPoint& point : points) {
    const double of_range_m = options.point_range_fraction * point.position.norm();
    const auto sigmas_m = [&](double variance) {
      const double of_position_m2 = std::max(0.0, variance) + of_range_m * of_range_m;
      return std::pair(std::sqrt(sharp_m * sharp_m + of_position_m2),
                       std::sqrt(rough_m * rough_m + of_position_m2));
    };
    Eigen::Vector3d normal;
    SurfaceDistance(start_in_camera, point.position, nullptr, &normal);
    const auto [sigma, rough_sigma] = sigmas_m(normal.dot(point.covariance * normal));
    const auto [least, rough_least] =
        sigmas_m(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>()
                     .computeDirect(point.covariance, Eigen::EigenvaluesOnly)
                     .eigenvalues()[0]);
    const double background = (1.0 - point.prior) / size_m;
    densities_.push_back({point.position, point.index, sigma, rough_sigma,
                          point.prior / Width(sigma, rough_sigma), background,
                          point.prior / Width(least, rough_least) + background});
  }
}

PointCost::Mixture PointCost::MixtureAt(const Density& density, double distance) const {
  const double near = Bell(distance / density.sigma_m);
  if (!(distance < 0.0)) {
    return {near * density.surface, 0.0, density.background, near * density.surface};
  }
  const double on_surface = (1.0 - kRoughShare) * density.surface;
  const double rough = kRoughShare * density.surface * Bell(distance / density.rough_sigma_m);
  return {near * (on_surface + (1.0 - outlier_probability_) * density.background), rough,
          outlier_probability_ * density.background, near * on_surface + rough};
}

std::pair<double, double> PointCost::CostAndWeight(const Density& density, double distance) const {
  const Mixture mixture = MixtureAt(density, distance);
  const double weight = (mixture.sharp / (density.sigma_m * density.sigma_m) +
                         mixture.rough / (density.rough_sigma_m * density.rough_sigma_m)) /
                        mixture.Sum();
  return {-std::log(mixture.Sum() / density.highest), weight};
}

double PointCost::FisherInformation(const Density& density, double distance) const {
  // Integral of the squared derivative of the cost, times the density, over a range of distances.
  const auto mean_squared_derivative = [&](double from, double to, double step) {
    double mean = 0.0;
    for (double at = from + 0.5 * step; at < to; at += step) {
      const double derivative = CostAndWeight(density, at).second * at;
      mean += step * derivative * derivative * MixtureAt(density, at).Sum();
    }
    return mean;
  };
  const double near = kFarthestSigmas * density.sigma_m;
  const double deep = kFarthestSigmas * density.rough_sigma_m;
  const double information =
      mean_squared_derivative(-near, near, kStepSigmas * density.sigma_m) +
      mean_squared_derivative(-deep, -near, kStepSigmas * density.rough_sigma_m);
  const double prior = density.surface * Width(density.sigma_m, density.rough_sigma_m);
  return information * MixtureAt(density, distance).Responsibility() / prior;
}

double PointCost::Value(const Landmark& landmark_in_camera) const {
  double cost = 0.0;
  for (const Density& density : densities_) {
    const double distance = SurfaceDistance(landmark_in_camera, density.position, nullptr);
    cost += CostAndWeight(density, distance).first;
  }
  return weight_ * cost;
}

void PointCost::AddTo(const Landmark& landmark_in_camera, LandmarkModel* sum) const {
  LandmarkModel model;
  for (const Density& density : densities_) {
    LandmarkJacobian1 jacobian;
    const double distance = SurfaceDistance(landmark_in_camera, density.position, &jacobian);
    const auto [cost, weight] = CostAndWeight(density, distance);
    model.cost += cost;
    model.gradient += weight * distance * jacobian.transpose();
    const double information = second_derivatives_ == SecondDerivatives::kMaximisation
                                   ? weight
                                   : FisherInformation(density, distance);
    model.information.noalias() += information * jacobian.transpose() * jacobian;
  }
  sum->Add(model, weight_);
}

std::vector<PointPosterior> PointCost::Posteriors(const Landmark& landmark_in_camera) const {
  std::vector<PointPosterior> posteriors;
  for (const Density& density : densities_) {
    const double distance = SurfaceDistance(landmark_in_camera, density.position, nullptr);
    posteriors.push_back({density.index, distance, MixtureAt(density, distance).Responsibility()});
  }
  return posteriors;
}

}  // namespace soslam

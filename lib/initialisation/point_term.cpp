// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/point_term.h"

#include <cmath>
#include <numbers>

#include "constraints/surface_distance.h"

namespace soslam {
namespace {

// Share of an object's points that may lie far inside its label's shape.
constexpr double kRoughShare = 0.6;

double Bell(double x) { return std::exp(-0.5 * x * x); }

}  // namespace

PointTerm::PointTerm(const std::vector<ObjectPoint>& points, const Landmark& start_in_camera,
                     const PointOptions& options, double weight)
    : outlier_probability_(options.point_outlier_probability), weight_(weight) {
  const double size = 2.0 * std::cbrt(start_in_camera.half_axes.prod());
  for (const ObjectPoint& point : points) {
    Eigen::Vector3d normal;
    SurfaceDistance(start_in_camera, point.position, nullptr, &normal);
    const double of_position = std::hypot(std::sqrt(normal.dot(point.covariance * normal)),
                                          options.point_range_fraction * point.position.norm());
    const double sigma = std::hypot(options.point_sigma_fraction * size, of_position);
    const double rough_sigma = std::hypot(options.point_roughness_fraction * size, of_position);
    const double width = std::sqrt(0.5 * std::numbers::pi) *
                         ((2.0 - kRoughShare) * sigma + kRoughShare * rough_sigma);
    densities_.push_back(
        {point.position, sigma, rough_sigma, point.prior / width, (1.0 - point.prior) / size});
  }
}

std::pair<double, double> PointTerm::CostAndWeight(const Density& density, double distance) const {
  const double near = Bell(distance / density.sigma_m);
  const bool is_inside = distance < 0.0;
  const double rough =
      is_inside ? kRoughShare * density.surface * Bell(distance / density.rough_sigma_m) : 0.0;
  const double sharp = near * (is_inside ? (1.0 - kRoughShare) * density.surface +
                                               (1.0 - outlier_probability_) * density.background
                                         : density.surface);
  const double constant = density.background * (is_inside ? outlier_probability_ : 1.0);
  const double sum = sharp + rough + constant;
  const double weight = (sharp / (density.sigma_m * density.sigma_m) +
                         rough / (density.rough_sigma_m * density.rough_sigma_m)) /
                        sum;
  return {-std::log(sum / (density.surface + density.background)), weight};
}

double PointTerm::Value(const Landmark& landmark_in_camera) const {
  double cost = 0.0;
  for (const Density& density : densities_) {
    const double distance = SurfaceDistance(landmark_in_camera, density.position, nullptr);
    cost += CostAndWeight(density, distance).first;
  }
  return weight_ * cost;
}

void PointTerm::AddTo(const Landmark& landmark_in_camera, LandmarkModel* sum) const {
  LandmarkModel model;
  for (const Density& density : densities_) {
    LandmarkJacobian1 jacobian;
    const double distance = SurfaceDistance(landmark_in_camera, density.position, &jacobian);
    const auto [cost, weight] = CostAndWeight(density, distance);
    model.cost += cost;
    model.gradient += weight * distance * jacobian.transpose();
    model.information += weight * jacobian.transpose() * jacobian;
  }
  sum->Add(model, weight_);
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/box_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/support_function.h"
#include "initialisation/levenberg_marquardt.h"

namespace soslam {
namespace {

constexpr int kMaxIterations = 50;
enum { kYaw, kFootX, kFootY, kLogA, kLogB, kLogC };

}  // namespace

BoxFit::BoxFit(const UprightObservation& observation)
    : observation_(observation),
      ground_(observation.plane_in_camera),
      box_(observation.edges, Rigid3d(), ground_),
      ratio_(observation.prior),
      axis_yaw_(std::atan2(observation.world_axis_in_camera.dot(ground_.y),
                           observation.world_axis_in_camera.dot(ground_.x))) {}

Eigen::Array4d BoxFit::TangentDepths(const UprightVector& start) const {
  const Heading heading(start[kYaw]);
  const Eigen::Vector3d half_axes = start.tail<3>().array().exp();
  const Eigen::Vector3d axis_in_object = heading.TurnedBack(box_.optical_axis);
  const double centre_depth = box_.DepthOf({start[kFootX], start[kFootY], half_axes.z()});
  Eigen::Array4d depths_m;
  for (int i = 0; i < 4; ++i) {
    const SupportValue support = SupportFunction(half_axes, observation_.prior.shape_exponent,
                                                 heading.TurnedBack(box_.normals.row(i)));
    depths_m[i] = centre_depth + axis_in_object.dot(support.contact);
  }
  return depths_m;
}

double BoxFit::NearestDepth(const UprightVector& at) const {
  const Eigen::Vector3d half_axes = at.tail<3>().array().exp();
  const Eigen::Vector3d axis_in_object = Heading(at[kYaw]).TurnedBack(box_.optical_axis);
  return box_.DepthOf({at[kFootX], at[kFootY], half_axes.z()}) -
         SupportFunction(half_axes, observation_.prior.shape_exponent, axis_in_object).extent;
}

void BoxFit::AddTangencies(const Eigen::Array4d& depths_m, const UprightVector& at,
                           QuadraticModel<6>* sum) const {
  const Heading heading(at[kYaw]);
  const Eigen::Vector3d half_axes = at.tail<3>().array().exp();
  const Eigen::Vector3d centre(at[kFootX], at[kFootY], half_axes.z());
  Eigen::Vector4d residuals = Eigen::Vector4d::Zero();
  Eigen::Matrix<double, 4, 6> jacobian = Eigen::Matrix<double, 4, 6>::Zero();
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d normal = box_.normals.row(i);
    const Eigen::Vector3d in_object = heading.TurnedBack(normal);
    const SupportValue support =
        SupportFunction(half_axes, observation_.prior.shape_exponent, in_object);
    const double outside = box_.at_origin[i] + normal.dot(centre) + support.extent;
    const double weight = 1.0 / (depths_m[i] * box_.sigma_px[i]);
    if (box_.is_bound[i] != 0.0 && weight * outside > 0.0) continue;
    Eigen::Matrix<double, 1, 6> by_parameters;
    by_parameters[kYaw] = support.contact.x() * in_object.y() - support.contact.y() * in_object.x();
    by_parameters.segment<2>(kFootX) = normal.head<2>();
    by_parameters.tail<3>() = support.by_log_half_axes;
    by_parameters[kLogC] += normal.z() * half_axes.z();
    residuals[i] = weight * outside;
    jacobian.row(i) = weight * by_parameters;
  }
  sum->cost += 0.5 * residuals.squaredNorm();
  sum->gradient += jacobian.transpose().lazyProduct(residuals);
  sum->information += jacobian.transpose().lazyProduct(jacobian);
}

void BoxFit::AddRatio(const Eigen::Vector3d& log_half_axes, QuadraticModel<6>* sum) const {
  const Eigen::Vector2d residuals = ratio_.Residuals(log_half_axes);
  sum->cost += 0.5 * residuals.squaredNorm();
  sum->gradient.tail<3>() += ratio_.by_log_half_axes.transpose().lazyProduct(residuals);
  sum->information.bottomRightCorner<3, 3>() += ratio_.information;
}

std::array<BoxFit::YawRow, 2> BoxFit::YawRows(double yaw) const {
  const double amplitude = std::sqrt(2.0 * observation_.axes_weight);
  const double angle = 2.0 * (yaw - axis_yaw_);
  const YawRow of_axes = {amplitude * std::sin(angle), 2.0 * amplitude * std::cos(angle)};
  if (!observation_.yaw_prior) return {of_axes, YawRow()};
  const YawPrior& prior = *observation_.yaw_prior;
  return {of_axes, {YawDifferenceModuloPi(yaw, prior.yaw) / prior.sigma, 1.0 / prior.sigma}};
}

double BoxFit::YawCost(double yaw) const {
  double cost = 0.0;
  for (const YawRow& row : YawRows(yaw)) cost += 0.5 * row.residual * row.residual;
  return cost;
}

QuadraticModel<6> BoxFit::Evaluate(const Eigen::Array4d& depths_m, const UprightVector& at) const {
  QuadraticModel<6> sum;
  AddTangencies(depths_m, at, &sum);
  AddRatio(at.tail<3>(), &sum);
  for (const YawRow& row : YawRows(at[kYaw])) {
    sum.cost += 0.5 * row.residual * row.residual;
    sum.gradient[kYaw] += row.by_yaw * row.residual;
    sum.information(kYaw, kYaw) += row.by_yaw * row.by_yaw;
  }
  return sum;
}

double BoxFit::Minimise(const LandmarkCosts& further, bool yaw_is_free,
                        UprightVector* start) const {
  const Eigen::Array4d depths_m = TangentDepths(*start);
  const double shape_exponent = observation_.prior.shape_exponent;
  const auto evaluate = [&](const UprightVector& at) {
    QuadraticModel<6> sum = Evaluate(depths_m, at);
    if (!further.empty()) {
      sum.Add(UprightModel(further, ground_, ground_.LandmarkAt(at, shape_exponent)));
    }
    if (!yaw_is_free) sum.Hold(kYaw);
    return sum;
  };
  return MinimiseSquares<6>(evaluate, kMaxIterations, start, NegligibleDecrease(further)) +
         ConstantCost(further);
}

std::vector<FitAtYaw> BoxFit::MinimiseAtYaws(std::span<const StartAtYaw> starts) const {
  std::vector<FitAtYaw> fits(
      starts.size(), {std::numeric_limits<double>::quiet_NaN(), UprightVector::Zero(), 0.0});
  if (!(box_.is_bound != 0.0).any()) {
    for (size_t first = 0; first < starts.size(); first += 4) {
      std::array<StartAtYaw, 4> four;
      for (size_t k = 0; k < four.size(); ++k) {
        four[k] = starts[std::min(first + k, starts.size() - 1)];
      }
      const auto found =
          FitFourYaws(box_, ratio_, observation_.prior.shape_exponent, kMaxIterations, four);
      for (size_t k = 0; k < four.size() && first + k < starts.size(); ++k) {
        fits[first + k] = found[k];
        fits[first + k].cost += YawCost(four[k].parameters[kYaw]);
      }
    }
  }
  // Whether edges that are bounds count depends on the foot; and others may not tell it.
  for (size_t i = 0; i < starts.size(); ++i) {
    FitAtYaw& fit = fits[i];
    if (!std::isnan(fit.cost)) continue;
    fit.parameters = starts[i].parameters;
    fit.cost = Minimise({}, /*yaw_is_free=*/false, &fit.parameters);
    fit.nearest_depth_m = NearestDepth(fit.parameters);
  }
  return fits;
}

}  // namespace soslam

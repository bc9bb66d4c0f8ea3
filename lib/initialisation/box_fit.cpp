// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/box_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/wide_loops.h"
#include "geometry/support_function.h"
#include "geometry/support_of_four.h"
#include "initialisation/levenberg_marquardt.h"

namespace soslam {
namespace {

constexpr int kMaxIterations = 50;
enum { kYaw, kFootX, kFootY, kLogA, kLogB, kLogC };

// An upright object in the ground frame.
struct Body {
  Body(double p, const UprightVector& at)
      : shape_exponent(p),
        heading(at[kYaw]),
        half_axes(at.tail<3>().array().exp()),
        centre(at[kFootX], at[kFootY], half_axes.z()) {}

  double shape_exponent;
  Heading heading;
  Eigen::Vector3d half_axes;
  Eigen::Vector3d centre;
};

// The four edges of a box, one per SIMD lane: normals of the planes behind them and the object's
// support function in these directions.
struct FourEdges {
  ThreeFours normals;    // in the ground frame
  ThreeFours in_object;  // in the object frame
  SupportOfFour support;
};

SOSLAM_FORCE_INLINE void FindEdges(const BoxOnGround& box, const Body& body, FourEdges* edges) {
  for (size_t i = 0; i < 3; ++i) Load(box.normals.col(i).data(), &edges->normals[i]);
  const auto& [x, y, z] = edges->normals;
  const auto [cosine, sine] = body.heading;
  edges->in_object = {cosine * x + sine * y, cosine * y - sine * x, z};
  FindSupport(body.half_axes, body.shape_exponent, edges->in_object, &edges->support);
}

SOSLAM_MULTIVERSION void FindTangentDepths(const BoxOnGround& box, const Body& body,
                                           Eigen::Array4d* depths_m) {
  FourEdges edges;
  FindEdges(box, body, &edges);
  const ThreeFours contact = edges.support.Contact(body.shape_exponent, edges.in_object);
  const Eigen::Vector3d axis_in_object = body.heading.TurnedBack(box.optical_axis);
  Four depths = Four{} + box.DepthOf(body.centre);
  for (size_t i = 0; i < 3; ++i) depths += axis_in_object[i] * contact[i];
  Store(depths, depths_m->data());
}

// Residuals (px / sigma) of the four edges and their Jacobian by UprightVector.
struct Rows {
  Eigen::Vector4d residuals;
  Eigen::Matrix<double, 4, 6> jacobian;
};

SOSLAM_MULTIVERSION void FindRows(const BoxOnGround& box, const Body& body,
                                  const Eigen::Array4d& depths_m, Rows* rows) {
  FourEdges edges;
  FindEdges(box, body, &edges);
  const SupportOfFour& support = edges.support;
  Four outside, depths, sigmas, is_bound;
  Load(box.at_origin.data(), &outside);
  Load(depths_m.data(), &depths);
  Load(box.sigma_px.data(), &sigmas);
  Load(box.is_bound.data(), &is_bound);
  for (size_t i = 0; i < 3; ++i) outside += edges.normals[i] * body.centre[i];
  outside += support.extent;
  Four weight = 1.0 / (depths * sigmas);
  const FourMask is_idle = (is_bound != 0.0) & (weight * outside > 0.0);
  Replace(is_idle, Four{}, &weight);
  Store(weight * outside, rows->residuals.data());

  const auto& [x, y, z] = edges.in_object;
  const std::array<Four, 6> by_parameters = {
      x * y * (support.shares[0] - support.shares[1]),
      edges.normals[0],
      edges.normals[1],
      support.by_log_half_axes[0],
      support.by_log_half_axes[1],
      support.by_log_half_axes[2] + z * body.half_axes.z(),
  };
  for (int i = 0; i < 6; ++i) Store(weight * by_parameters[i], rows->jacobian.col(i).data());
}

}  // namespace

BoxFit::BoxFit(const UprightObservation& observation)
    : observation_(observation),
      ground_(observation.plane_in_camera),
      box_(observation.edges, Rigid3d(), ground_),
      ratio_(observation.prior),
      twice_the_axis_(2.0 * std::atan2(observation.world_axis_in_camera.dot(ground_.y),
                                       observation.world_axis_in_camera.dot(ground_.x))) {}

Eigen::Array4d BoxFit::TangentDepths(const UprightVector& start) const {
  Eigen::Array4d depths_m;
  FindTangentDepths(box_, Body(observation_.prior.shape_exponent, start), &depths_m);
  return depths_m;
}

double BoxFit::NearestDepth(const UprightVector& at) const {
  const Body body(observation_.prior.shape_exponent, at);
  const Eigen::Vector3d axis_in_object = body.heading.TurnedBack(box_.optical_axis);
  return box_.DepthOf(body.centre) -
         SupportFunction(body.half_axes, body.shape_exponent, axis_in_object).extent;
}

void BoxFit::AddRatio(const Eigen::Vector3d& log_half_axes, QuadraticModel<6>* sum) const {
  const Eigen::Vector2d residuals = ratio_.Residuals(log_half_axes);
  sum->cost += 0.5 * residuals.squaredNorm();
  sum->gradient.tail<3>() += ratio_.by_log_half_axes.transpose().lazyProduct(residuals);
  sum->information.bottomRightCorner<3, 3>() += ratio_.information;
}

std::array<BoxFit::YawRow, 2> BoxFit::YawRows(double yaw, const Heading& heading_of_yaw) const {
  const double amplitude = std::sqrt(2.0 * observation_.axes_weight);
  // Sine and cosine of twice the angle between yaw and axis.
  const auto [c, s] = heading_of_yaw;
  const Eigen::Vector3d from_axis = twice_the_axis_.TurnedBack({c * c - s * s, 2.0 * s * c, 0.0});
  const YawRow of_axes = {amplitude * from_axis.y(), 2.0 * amplitude * from_axis.x()};
  if (!observation_.yaw_prior) return {of_axes, YawRow()};
  const YawPrior& prior = *observation_.yaw_prior;
  return {of_axes, {YawDifferenceModuloPi(yaw, prior.yaw) / prior.sigma, 1.0 / prior.sigma}};
}

double BoxFit::YawCost(const StartAtYaw& start) const {
  double cost = 0.0;
  for (const YawRow& row : YawRows(start.parameters[kYaw], start.heading)) {
    cost += 0.5 * row.residual * row.residual;
  }
  return cost;
}

QuadraticModel<6> BoxFit::Evaluate(const Eigen::Array4d& depths_m, const UprightVector& at) const {
  QuadraticModel<6> sum;
  const Body body(observation_.prior.shape_exponent, at);
  Rows rows;
  FindRows(box_, body, depths_m, &rows);
  sum.cost = 0.5 * rows.residuals.squaredNorm();
  sum.gradient = rows.jacobian.transpose().lazyProduct(rows.residuals);
  sum.information = rows.jacobian.transpose().lazyProduct(rows.jacobian);
  AddRatio(at.tail<3>(), &sum);
  for (const YawRow& row : YawRows(at[kYaw], body.heading)) {
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
        fits[first + k].cost += YawCost(four[k]);
      }
    }
  }
  // Bound edges contribute or not depending on the foot, and other edges may not determine it: in
  // these cases FitFourYaws has no result.
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

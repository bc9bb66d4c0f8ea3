// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/box_fit.h"

#include <array>
#include <cmath>

#include "geometry/support_function.h"
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

// Residuals (px / sigma) of the four edges and their Jacobian by UprightVector.
struct Rows {
  Eigen::Vector4d residuals;
  Eigen::Matrix<double, 4, 6> jacobian;
};

Rows FindRows(const BoxOnGround& box, const Body& body, const Eigen::Array4d& depths_m) {
  Rows rows;
  for (int edge = 0; edge < 4; ++edge) {
    const Eigen::Vector3d normal = box.normals.row(edge);
    const Eigen::Vector3d in_object = body.heading.TurnedBack(normal);
    const SupportValue support = SupportFunction(body.half_axes, body.shape_exponent, in_object);
    const double outside = box.at_origin[edge] + normal.dot(body.centre) + support.extent;
    double weight = 1.0 / (depths_m[edge] * box.sigma_px[edge]);
    if (box.is_bound[edge] != 0.0 && weight * outside > 0.0) weight = 0.0;
    rows.residuals[edge] = weight * outside;
    const Eigen::Vector3d& contact = support.contact;
    rows.jacobian.row(edge) << contact.x() * in_object.y() - contact.y() * in_object.x(),
        normal.x(), normal.y(), support.by_log_half_axes.transpose();
    rows.jacobian(edge, kLogC) += normal.z() * body.half_axes.z();
    rows.jacobian.row(edge) *= weight;
  }
  return rows;
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
  const Body body(observation_.prior.shape_exponent, start);
  const Eigen::Vector3d axis_in_object = body.heading.TurnedBack(box_.optical_axis);
  Eigen::Array4d depths_m;
  for (int edge = 0; edge < 4; ++edge) {
    const Eigen::Vector3d in_object = body.heading.TurnedBack(box_.normals.row(edge));
    const SupportValue support = SupportFunction(body.half_axes, body.shape_exponent, in_object);
    depths_m[edge] = box_.DepthOf(body.centre) + axis_in_object.dot(support.contact);
  }
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

QuadraticModel<6> BoxFit::Evaluate(const Eigen::Array4d& depths_m, const UprightVector& at) const {
  QuadraticModel<6> sum;
  const Body body(observation_.prior.shape_exponent, at);
  const Rows rows = FindRows(box_, body, depths_m);
  sum.cost = 0.5 * rows.residuals.squaredNorm();
  sum.gradient = rows.jacobian.transpose() * rows.residuals;
  sum.information = rows.jacobian.transpose() * rows.jacobian;
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

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/upright.h"

#include <ceres/tiny_solver.h>

#include <cmath>
#include <limits>

namespace soslam {
namespace {

constexpr int kMaxIterations = 50;

// Horizontal axes and the point that foot coordinates count from.
struct Ground {
  explicit Ground(const Plane& plane)
      : x(UprightRotation(plane.normal, 0.0) * Eigen::Vector3d::UnitX()),
        y(plane.normal.cross(x)),
        origin(-plane.offset * plane.normal) {}

  Eigen::Vector3d x;
  Eigen::Vector3d y;
  Eigen::Vector3d origin;
};

// The sum of all terms, as ceres::TinySolver wants it.
class UprightCost {
 public:
  using Scalar = double;
  enum { NUM_PARAMETERS = 6, NUM_RESIDUALS = Eigen::Dynamic };

  UprightCost(const Plane& plane, double shape_exponent, const LandmarkTerms& terms,
              bool yaw_is_free)
      : plane_(plane), shape_exponent_(shape_exponent), terms_(terms), yaw_is_free_(yaw_is_free) {
    for (const auto& term : terms) num_residuals_ += term->NumResiduals();
  }

  int NumResiduals() const { return num_residuals_; }

  bool operator()(const double* parameters, double* residuals, double* jacobian) const {
    const Landmark landmark =
        UprightLandmark(plane_, Eigen::Map<const UprightVector>(parameters), shape_exponent_);
    Eigen::Map<Eigen::VectorXd> all(residuals, num_residuals_);
    LandmarkTerm::Jacobian by_landmark(jacobian != nullptr ? num_residuals_ : 0, kLandmarkDof);
    LandmarkTerm::Jacobian by_landmark_of_term;
    int row = 0;
    for (const auto& term : terms_) {
      const int rows = term->NumResiduals();
      if (jacobian != nullptr) by_landmark_of_term.resize(rows, kLandmarkDof);
      term->Evaluate(landmark, all.segment(row, rows),
                     jacobian != nullptr ? &by_landmark_of_term : nullptr);
      if (jacobian != nullptr) by_landmark.middleRows(row, rows) = by_landmark_of_term;
      row += rows;
    }
    if (jacobian != nullptr) {
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, 6>> map(jacobian, num_residuals_, 6);
      map = by_landmark * UprightByParameters(plane_, landmark);
      if (!yaw_is_free_) map.col(0).setZero();
    }
    return all.allFinite();
  }

 private:
  const Plane& plane_;
  double shape_exponent_;
  const LandmarkTerms& terms_;
  bool yaw_is_free_;
  int num_residuals_ = 0;
};

}  // namespace

Landmark UprightLandmark(const Plane& plane, const UprightVector& parameters,
                         double shape_exponent) {
  const Ground ground(plane);
  Landmark landmark;
  landmark.half_axes = parameters.tail<3>().array().exp();
  landmark.shape_exponent = shape_exponent;
  landmark.frame_from_object = {UprightRotation(plane.normal, parameters(0)),
                                ground.origin + parameters(1) * ground.x +
                                    parameters(2) * ground.y +
                                    landmark.half_axes.z() * plane.normal};
  return landmark;
}

UprightVector UprightParameters(const Plane& plane, const Landmark& landmark) {
  const Ground ground(plane);
  const Eigen::Vector3d from_origin = landmark.Centre() - ground.origin;
  UprightVector parameters;
  parameters << Yaw(plane.normal, landmark.frame_from_object.rotation), from_origin.dot(ground.x),
      from_origin.dot(ground.y), landmark.half_axes.array().log().matrix();
  return parameters;
}

UprightJacobian UprightByParameters(const Plane& plane, const Landmark& landmark) {
  const Ground ground(plane);
  UprightJacobian jacobian = UprightJacobian::Zero();
  jacobian.block<3, 1>(0, 0) = plane.normal;
  jacobian.block<3, 1>(3, 1) = ground.x;
  jacobian.block<3, 1>(3, 2) = ground.y;
  jacobian.block<3, 1>(3, 5) = landmark.half_axes.z() * plane.normal;
  jacobian.block<3, 3>(6, 3).setIdentity();
  return jacobian;
}

BoxTerm::BoxTerm(const std::array<BoxEdge, 4>& edges, const Landmark& start_in_camera)
    : edges_(edges) {
  for (size_t i = 0; i < edges.size(); ++i) depths_m_[i] = TangentDepth(edges[i], start_in_camera);
}

void BoxTerm::Evaluate(const Landmark& landmark_in_camera, Eigen::Ref<Eigen::VectorXd> residuals,
                       Jacobian* jacobian) const {
  for (size_t i = 0; i < edges_.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    LandmarkJacobian1 by_landmark;
    residuals[row] = Tangency(edges_[i], landmark_in_camera, depths_m_[i], 0.0, &by_landmark);
    if (jacobian != nullptr) jacobian->row(row) = by_landmark;
  }
}

void OutlineTerm::Evaluate(const Landmark& landmark_in_camera,
                           Eigen::Ref<Eigen::VectorXd> residuals, Jacobian* jacobian) const {
  if (!IsInFront(landmark_in_camera)) {
    residuals.setConstant(std::numeric_limits<double>::quiet_NaN());
    if (jacobian != nullptr) jacobian->setConstant(std::numeric_limits<double>::quiet_NaN());
    return;
  }
  for (size_t i = 0; i < edges_.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    LandmarkJacobian1 by_landmark;
    residuals[row] = OutlineExcess(edges_[i], landmark_in_camera, &by_landmark);
    if (jacobian != nullptr) jacobian->row(row) = by_landmark;
  }
}

void RatioTerm::Evaluate(const Landmark& landmark_in_camera, Eigen::Ref<Eigen::VectorXd> residuals,
                         Jacobian* jacobian) const {
  if (jacobian != nullptr) jacobian->setZero();
  for (int i = 0; i < 2; ++i) {
    const double weight = 1.0 / prior_.log_sigma[i];
    residuals[i] = weight * std::log(landmark_in_camera.half_axes[i] /
                                     (prior_.ratio[i] * landmark_in_camera.half_axes.z()));
    if (jacobian == nullptr) continue;
    (*jacobian)(i, 6 + i) = weight;
    (*jacobian)(i, 8) = -weight;
  }
  const double correlation = prior_.log_correlation;
  const double unexplained = std::sqrt(1.0 - correlation * correlation);
  residuals[1] = (residuals[1] - correlation * residuals[0]) / unexplained;
  if (jacobian == nullptr) return;
  jacobian->row(1) = (jacobian->row(1) - correlation * jacobian->row(0)) / unexplained;
}

void HeightTerm::Evaluate(const Landmark& landmark_in_camera, Eigen::Ref<Eigen::VectorXd> residuals,
                          Jacobian* jacobian) const {
  residuals[0] =
      std::log(2.0 * landmark_in_camera.half_axes.z() / height_m_.median) / height_m_.log_sigma;
  if (jacobian == nullptr) return;
  jacobian->setZero();
  (*jacobian)(0, 8) = 1.0 / height_m_.log_sigma;
}

void RobustViewTerm::Evaluate(const Landmark& landmark_in_reference,
                              Eigen::Ref<Eigen::VectorXd> residuals, Jacobian* jacobian) const {
  term_->Evaluate(Transform(camera_from_reference_, landmark_in_reference), residuals, jacobian);
  if (jacobian != nullptr) {
    const Eigen::Matrix3d rotation = camera_from_reference_.rotation.toRotationMatrix();
    for (int block = 0; block < 2; ++block) {
      jacobian->middleCols<3>(3 * block) = (jacobian->middleCols<3>(3 * block) * rotation).eval();
    }
  }
  // Half the square of the new residual is the Huber loss of the old one.
  for (Eigen::Index i = 0; i < residuals.size(); ++i) {
    const double size = std::abs(residuals[i]);
    if (!(size > huber_delta_)) continue;
    const double root = std::sqrt(huber_delta_ * (2.0 * size - huber_delta_));
    const double slope = huber_delta_ / root;
    residuals[i] = std::copysign(root, residuals[i]);
    if (jacobian != nullptr) jacobian->row(i) *= slope;
  }
  residuals *= root_weight_;
  if (jacobian != nullptr) *jacobian *= root_weight_;
}

Eigen::Vector3d WorldAxis(const Plane& plane_in_world) {
  return UprightRotation(plane_in_world.normal, 0.0) * Eigen::Vector3d::UnitX();
}

AxisTerm::AxisTerm(const Plane& plane_in_camera, const Eigen::Vector3d& axis_in_camera,
                   double weight)
    : normal_(plane_in_camera.normal),
      axis_yaw_(Yaw(normal_,
                    Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), axis_in_camera))),
      amplitude_(std::sqrt(2.0 * weight)) {}

void AxisTerm::Evaluate(const Landmark& landmark_in_camera, Eigen::Ref<Eigen::VectorXd> residuals,
                        Jacobian* jacobian) const {
  const double angle =
      2.0 * (Yaw(normal_, landmark_in_camera.frame_from_object.rotation) - axis_yaw_);
  residuals[0] = amplitude_ * std::sin(angle);
  if (jacobian == nullptr) return;
  jacobian->setZero();
  jacobian->leftCols<3>() = 2.0 * amplitude_ * std::cos(angle) * normal_.transpose();
}

double TotalCost(const LandmarkTerms& terms, const Landmark& landmark) {
  double cost = 0.0;
  for (const auto& term : terms) {
    Eigen::VectorXd residuals(term->NumResiduals());
    term->Evaluate(landmark, residuals, nullptr);
    cost += 0.5 * residuals.squaredNorm() + term->ConstantCost();
  }
  return cost;
}

std::optional<UprightSolution> FitUpright(const Plane& plane_in_camera, const Landmark& start,
                                          const LandmarkTerms& terms, bool yaw_is_free) {
  const UprightCost cost(plane_in_camera, start.shape_exponent, terms, yaw_is_free);
  ceres::TinySolver<UprightCost> solver;
  solver.options.max_num_iterations = kMaxIterations;
  solver.options.gradient_tolerance = 1e-10;
  solver.options.parameter_tolerance = 1e-8;
  UprightVector parameters = UprightParameters(plane_in_camera, start);
  // The solver takes a start without a cost for an optimum.
  Eigen::VectorXd residuals(cost.NumResiduals());
  if (!cost(parameters.data(), residuals.data(), nullptr)) return std::nullopt;
  solver.Solve(cost, &parameters);
  if (!std::isfinite(solver.summary.final_cost) || !parameters.allFinite()) return std::nullopt;
  double constant_cost = 0.0;
  for (const auto& term : terms) constant_cost += term->ConstantCost();
  return UprightSolution{UprightLandmark(plane_in_camera, parameters, start.shape_exponent),
                         solver.summary.final_cost + constant_cost};
}

}  // namespace soslam

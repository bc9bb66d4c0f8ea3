// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/upright.h"

#include <cmath>
#include <limits>

#include "initialisation/levenberg_marquardt.h"

namespace soslam {
namespace {

constexpr int kMaxIterations = 50;

// Sums the terms at upright parameters.
class UprightCost {
 public:
  UprightCost(const UprightGround& ground, double shape_exponent, const LandmarkTerms& terms,
              bool yaw_is_free)
      : ground_(ground), shape_exponent_(shape_exponent), terms_(terms), yaw_is_free_(yaw_is_free) {
    for (const auto& term : terms) {
      residuals_.emplace_back(term->NumResiduals());
      jacobians_.emplace_back(term->NumResiduals(), kLandmarkDof);
    }
  }

  NormalEquations<6> operator()(const UprightVector& parameters) {
    const Landmark landmark = ground_.LandmarkAt(parameters, shape_exponent_);
    const UprightJacobian by_parameters = ground_.ByParameters(landmark);
    NormalEquations<6> sum;
    for (size_t i = 0; i < terms_.size(); ++i) {
      terms_[i]->Evaluate(landmark, residuals_[i], &jacobians_[i]);
      for (Eigen::Index row = 0; row < residuals_[i].size(); ++row) {
        sum.Add(residuals_[i][row], by_parameters.transpose() * jacobians_[i].row(row).transpose());
      }
    }
    if (!yaw_is_free_) sum.Hold(0);
    return sum;
  }

 private:
  const UprightGround& ground_;
  double shape_exponent_;
  const LandmarkTerms& terms_;
  bool yaw_is_free_;
  std::vector<Eigen::VectorXd> residuals_;  // of each term, here so that they are allocated once
  std::vector<LandmarkTerm::Jacobian> jacobians_;
};

}  // namespace

UprightGround::UprightGround(const Plane& plane)
    : rotation(UprightRotation(plane.normal, 0.0)),
      x(rotation * Eigen::Vector3d::UnitX()),
      y(plane.normal.cross(x)),
      normal(plane.normal),
      origin(-plane.offset * plane.normal) {}

Landmark UprightGround::LandmarkAt(const UprightVector& parameters, double shape_exponent) const {
  Landmark landmark;
  landmark.half_axes = parameters.tail<3>().array().exp();
  landmark.shape_exponent = shape_exponent;
  const double half_yaw = 0.5 * parameters[0];
  const Eigen::Quaterniond turn(std::cos(half_yaw), 0.0, 0.0, std::sin(half_yaw));
  landmark.frame_from_object = {
      (rotation * turn).normalized(),
      origin + parameters[1] * x + parameters[2] * y + landmark.half_axes.z() * normal};
  return landmark;
}

UprightVector UprightGround::ParametersOf(const Landmark& landmark) const {
  const Eigen::Vector3d from_origin = landmark.Centre() - origin;
  UprightVector parameters;
  parameters << Yaw(normal, landmark.frame_from_object.rotation), from_origin.dot(x),
      from_origin.dot(y), landmark.half_axes.array().log().matrix();
  return parameters;
}

UprightJacobian UprightGround::ByParameters(const Landmark& landmark) const {
  UprightJacobian jacobian = UprightJacobian::Zero();
  jacobian.block<3, 1>(0, 0) = normal;
  jacobian.block<3, 1>(3, 1) = x;
  jacobian.block<3, 1>(3, 2) = y;
  jacobian.block<3, 1>(3, 5) = landmark.half_axes.z() * normal;
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

std::optional<UprightSolution> FitUpright(const Plane& plane, const Landmark& start,
                                          const LandmarkTerms& terms, bool yaw_is_free) {
  const UprightGround ground(plane);
  UprightVector parameters = ground.ParametersOf(start);
  double cost = MinimiseSquares<6>(UprightCost(ground, start.shape_exponent, terms, yaw_is_free),
                                   kMaxIterations, &parameters);
  if (!std::isfinite(cost) || !parameters.allFinite()) return std::nullopt;
  for (const auto& term : terms) cost += term->ConstantCost();
  return UprightSolution{ground.LandmarkAt(parameters, start.shape_exponent), cost};
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/upright.h"

#include <cmath>
#include <limits>

#include "constraints/loss.h"
#include "initialisation/levenberg_marquardt.h"

namespace soslam {
namespace {

constexpr int kMaxIterations = 50;

using Residuals = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, LandmarkTerm::kMaxResiduals>;

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

double LandmarkTerm::Value(const Landmark& landmark) const {
  Residuals residuals(NumResiduals());
  Evaluate(landmark, residuals, nullptr);
  return 0.5 * residuals.squaredNorm();
}

void LandmarkTerm::AddTo(const Landmark& landmark, LandmarkModel* sum) const {
  Residuals residuals(NumResiduals());
  Jacobian jacobian(NumResiduals(), kLandmarkDof);
  Evaluate(landmark, residuals, &jacobian);
  for (Eigen::Index row = 0; row < residuals.size(); ++row) {
    sum->Add(residuals[row], jacobian.row(row).transpose());
  }
}

BoxTerm::BoxTerm(const std::array<BoxEdge, 4>& edges, const Landmark& start_in_camera)
    : edges_(edges) {
  for (size_t i = 0; i < edges.size(); ++i)
    depths_[i] = FindTangentDepth(edges[i], start_in_camera);
}

void BoxTerm::Evaluate(const Landmark& landmark_in_camera, Eigen::Ref<Eigen::VectorXd> residuals,
                       Jacobian* jacobian) const {
  for (size_t i = 0; i < edges_.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    LandmarkJacobian1 by_landmark;
    residuals[row] = Tangency(edges_[i], landmark_in_camera, depths_[i], 0.0, &by_landmark);
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
  residuals = rows_.Residuals(landmark_in_camera.half_axes.array().log());
  if (jacobian == nullptr) return;
  jacobian->setZero();
  jacobian->rightCols<3>() = rows_.by_log_half_axes;
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
    const double root = std::sqrt(2.0 * EvaluateLoss(ceres::HuberLoss(huber_delta_), size).cost);
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

QuadraticModel<6> UprightModel(const LandmarkCosts& costs, const UprightGround& ground,
                               const Landmark& landmark) {
  LandmarkModel sum;
  for (const auto& cost : costs) cost->AddTo(landmark, &sum);
  return sum.Chained(ground.ByParameters(landmark));
}

std::optional<UprightSolution> FitUpright(const Plane& plane, const Landmark& start,
                                          const LandmarkCosts& costs, bool yaw_is_free) {
  const UprightGround ground(plane);
  const double shape_exponent = start.shape_exponent;
  const auto evaluate = [&](const UprightVector& at) {
    QuadraticModel<6> sum = UprightModel(costs, ground, ground.LandmarkAt(at, shape_exponent));
    if (!yaw_is_free) sum.Hold(0);
    return sum;
  };
  UprightVector parameters = ground.ParametersOf(start);
  const double cost =
      MinimiseSquares<6>(evaluate, kMaxIterations, &parameters, NegligibleDecrease(costs));
  if (!std::isfinite(cost) || !parameters.allFinite()) return std::nullopt;
  return UprightSolution{ground.LandmarkAt(parameters, shape_exponent), cost + ConstantCost(costs)};
}

}  // namespace soslam

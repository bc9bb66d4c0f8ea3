// SPDX-License-Identifier: BSD-3-Clause
#include "constraints/landmark_cost.h"

#include <algorithm>
#include <utility>

#include "base/levenberg_marquardt.h"

namespace soslam {

double ConstantCost(const LandmarkCosts& costs) {
  double sum = 0.0;
  for (const auto& cost : costs) sum += cost->ConstantCost();
  return sum;
}

double TotalCost(const LandmarkCosts& costs, const Landmark& landmark) {
  double sum = ConstantCost(costs);
  for (const auto& cost : costs) sum += cost->Value(landmark);
  return sum;
}

LandmarkModel ModelOf(const LandmarkCosts& costs, const Landmark& landmark) {
  LandmarkModel sum;
  for (const auto& cost : costs) cost->AddTo(landmark, &sum);
  return sum;
}

double NegligibleDecrease(const LandmarkCosts& costs) {
  // Where convergence is slow, the last steps would take most of the time. A step that is left out
  // changes the likelihood by about a thousandth at a cost of 100, by less at a lower one.
  constexpr double kNegligibleDecreaseWhereSlow = 1e-5;
  const bool is_slow =
      std::ranges::any_of(costs, [](const auto& cost) { return cost->ConvergesSlowly(); });
  return is_slow ? kNegligibleDecreaseWhereSlow : kNegligibleDecrease;
}

ViewCost::ViewCost(std::unique_ptr<const LandmarkCost> in_camera,
                   const Rigid3d& camera_from_reference, double weight)
    : in_camera_(std::move(in_camera)),
      camera_from_reference_(camera_from_reference),
      weight_(weight) {}

double ViewCost::Value(const Landmark& landmark_in_reference) const {
  return weight_ * in_camera_->Value(Transform(camera_from_reference_, landmark_in_reference));
}

void ViewCost::AddTo(const Landmark& landmark_in_reference, LandmarkModel* sum) const {
  LandmarkModel in_camera;
  in_camera_->AddTo(Transform(camera_from_reference_, landmark_in_reference), &in_camera);
  sum->Add(in_camera.Chained(
               LandmarkInCameraJacobian(camera_from_reference_.rotation.toRotationMatrix())),
           weight_);
}

Eigen::Matrix<double, kLandmarkDof, kLandmarkDof> LandmarkInCameraJacobian(
    const Eigen::Matrix3d& rotation_camera_from_reference) {
  Eigen::Matrix<double, kLandmarkDof, kLandmarkDof> jacobian;
  jacobian.setIdentity();
  jacobian.block<3, 3>(0, 0) = rotation_camera_from_reference;
  jacobian.block<3, 3>(3, 3) = rotation_camera_from_reference;
  return jacobian;
}

}  // namespace soslam

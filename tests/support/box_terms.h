// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "initialisation/upright.h"
#include "initialisation/upright_observation.h"

namespace soslam {

// The yaw against its prior's, modulo half a turn.
class YawTerm final : public LandmarkTerm {
 public:
  YawTerm(const Plane& plane_in_camera, const YawPrior& prior)
      : normal_(plane_in_camera.normal), prior_(prior) {}
  int NumResiduals() const override { return 1; }
  void Evaluate(const Landmark& landmark_in_camera, Eigen::Ref<Eigen::VectorXd> residuals,
                Jacobian* jacobian) const override {
    const double yaw = Yaw(normal_, landmark_in_camera.frame_from_object.rotation);
    residuals[0] = YawDifferenceModuloPi(yaw, prior_.yaw) / prior_.sigma;
    if (jacobian == nullptr) return;
    jacobian->setZero();
    jacobian->leftCols<3>() = normal_.transpose() / prior_.sigma;
  }

 private:
  Eigen::Vector3d normal_;
  YawPrior prior_;
};

// What an observation says of a landmark: box (tangent points at the depths of `start`), ratio
// prior, world axes and yaw prior, term by term. BoxFit is the same.
inline LandmarkCosts BoxTerms(const UprightObservation& observation,
                              const Landmark& start_in_camera) {
  LandmarkCosts terms;
  terms.push_back(std::make_unique<BoxTerm>(observation.edges, start_in_camera));
  terms.push_back(std::make_unique<RatioTerm>(observation.prior));
  terms.push_back(std::make_unique<AxisTerm>(
      observation.plane_in_camera, observation.world_axis_in_camera, observation.axes_weight));
  if (observation.yaw_prior) {
    terms.push_back(std::make_unique<YawTerm>(observation.plane_in_camera, *observation.yaw_prior));
  }
  return terms;
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "geometry/plane.h"
#include "initialisation/upright.h"

namespace soslam {

// What is known of an object's yaw (rad, see Yaw) before its box is looked at; modulo half a turn.
struct YawPrior {
  double yaw = 0.0;
  double sigma = 1.0;  // standard deviation, rad
};

// The yaw against its prior's, modulo half a turn.
class YawTerm final : public LandmarkTerm {
 public:
  YawTerm(const Plane& plane_in_camera, const YawPrior& prior)
      : normal_(plane_in_camera.normal), prior_(prior) {}
  int NumResiduals() const override { return 1; }
  void Evaluate(const Landmark& landmark_in_camera, Eigen::Ref<Eigen::VectorXd> residuals,
                Jacobian* jacobian) const override;

 private:
  Eigen::Vector3d normal_;
  YawPrior prior_;
};

}  // namespace soslam

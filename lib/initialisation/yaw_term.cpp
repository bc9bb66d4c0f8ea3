// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/yaw_term.h"

namespace soslam {

void YawTerm::Evaluate(const Landmark& landmark_in_camera, Eigen::Ref<Eigen::VectorXd> residuals,
                       Jacobian* jacobian) const {
  const double yaw = Yaw(normal_, landmark_in_camera.frame_from_object.rotation);
  residuals[0] = YawDifferenceModuloPi(yaw, prior_.yaw) / prior_.sigma;
  if (jacobian == nullptr) return;
  jacobian->setZero();
  jacobian->leftCols<3>() = normal_.transpose() / prior_.sigma;
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/resting_face.h"

namespace soslam {

Eigen::Matrix3d OwnFromObject(RestingFace face) {
  Eigen::Matrix3d own_from_object = Eigen::Matrix3d::Identity();
  if (face == RestingFace::kBack) {
    own_from_object << 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 0.0, 0.0;
  } else if (face == RestingFace::kSide) {
    own_from_object << 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -1.0, 0.0;
  }
  return own_from_object;
}

Eigen::Vector3d HalfAxesOnFace(const Eigen::Vector3d& own_half_axes, RestingFace face) {
  return OwnFromObject(face).cwiseAbs().transpose() * own_half_axes;
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/nearest_rotation.h"

#include <fmt/format.h>

#include <Eigen/Dense>

#include "base/error.h"

namespace soslam {

Eigen::Quaterniond NearestRotation(const Eigen::Matrix3d& matrix, const std::string& place) {
  constexpr double kTolerance = 1e-3;  // of each entry of R R^T: three digits were kept at least
  const double deviation =
      (matrix * matrix.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(deviation <= kTolerance)) {
    throw InputError(
        fmt::format("{}: rotation is not orthonormal, R R^T is off by {:.3g}; expected at most {}",
                    place, deviation, kTolerance));
  }
  if (matrix.determinant() < 0.0) {
    throw InputError(place +
                     ": rotation has determinant -1; expected 1, a matrix without mirroring");
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return Eigen::Quaterniond(Eigen::Matrix3d(svd.matrixU() * svd.matrixV().transpose()))
      .normalized();
}

Rigid3d RigidMotion(const Eigen::Matrix4d& matrix, const std::string& place) {
  constexpr double kTolerance = 1e-6;
  const Eigen::RowVector4d last = matrix.row(3);
  if (!((last - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() <= kTolerance)) {
    throw InputError(fmt::format(
        "{}: last row of the 4 x 4 matrix is {} {} {} {}; expected 0 0 0 1: is it transposed?",
        place, last[0], last[1], last[2], last[3]));
  }
  return {NearestRotation(matrix.topLeftCorner<3, 3>(), place), matrix.topRightCorner<3, 1>()};
}

}  // namespace soslam

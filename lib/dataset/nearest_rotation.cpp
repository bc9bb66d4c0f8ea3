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

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/trajectory_error.h"

#include <Eigen/Dense>
#include <cmath>

namespace soslam {

std::optional<double> AbsoluteTrajectoryError(
    const std::vector<Rigid3d>& world_from_camera,
    const std::vector<std::optional<Rigid3d>>& true_world_from_camera) {
  std::vector<size_t> with_truth;
  for (size_t i = 0; i < world_from_camera.size(); ++i) {
    if (true_world_from_camera[i]) with_truth.push_back(i);
  }
  if (with_truth.size() < 3) return std::nullopt;
  Eigen::Matrix3Xd estimated(3, with_truth.size());
  Eigen::Matrix3Xd truth(3, with_truth.size());
  for (size_t i = 0; i < with_truth.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    estimated.col(column) = world_from_camera[with_truth[i]].translation;
    truth.col(column) = true_world_from_camera[with_truth[i]]->translation;
  }
  const Eigen::Matrix4d truth_from_estimated = Eigen::umeyama(estimated, truth, false);
  const Eigen::Matrix3Xd residuals =
      ((truth_from_estimated.topLeftCorner<3, 3>() * estimated).colwise() +
       Eigen::Vector3d(truth_from_estimated.topRightCorner<3, 1>())) -
      truth;
  return std::sqrt(residuals.squaredNorm() / static_cast<double>(with_truth.size()));
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/trajectory_error.h"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "evaluation/statistics.h"
#include "geometry/angles.h"

namespace soslam {

TrajectoryGap GapOf(const std::vector<PosePair>& pairs) {
  std::vector<double> rotations, translations;
  for (const auto& [estimated, truth] : pairs) {
    rotations.push_back(kDegPerRad * estimated.rotation.angularDistance(truth.rotation));
    translations.push_back((estimated.translation - truth.translation).norm());
  }
  return {*MedianOf(rotations), *MedianOf(translations)};
}

double ExtentOf(const std::vector<PosePair>& pairs, Rigid3d PosePair::*pose) {
  Eigen::AlignedBox3d around;
  for (const PosePair& pair : pairs) around.extend((pair.*pose).translation);
  return around.diagonal().norm();
}

namespace {

// Distance of a camera from the middle of its path (m). Both are medians, which single wrong poses
// do not move.
double SpreadOf(const std::vector<PosePair>& pairs, Rigid3d PosePair::*pose) {
  Eigen::Vector3d middle;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::vector<double> coordinates;
    for (const PosePair& pair : pairs) coordinates.push_back((pair.*pose).translation[axis]);
    middle[axis] = *MedianOf(coordinates);
  }
  std::vector<double> distances;
  for (const PosePair& pair : pairs) {
    distances.push_back(((pair.*pose).translation - middle).norm());
  }
  return *MedianOf(distances);
}

}  // namespace

bool HaveSameScale(const std::vector<PosePair>& pairs) {
  constexpr double kLargestRatio = 1.5;
  constexpr double kLeastM = 0.1;
  const double truth = std::max(kLeastM, SpreadOf(pairs, &PosePair::truth));
  const double estimated = std::max(kLeastM, SpreadOf(pairs, &PosePair::estimated));
  return std::max(truth, estimated) <= kLargestRatio * std::min(truth, estimated);
}

bool IsDrift(const TrajectoryGap& gap, double extent_m) {
  constexpr double kMostDeg = 20.0;
  constexpr double kMostShare = 0.3;
  constexpr double kLeastM = 0.1;
  return gap.rotation_deg <= kMostDeg &&
         gap.translation_m <= std::max(kLeastM, kMostShare * extent_m);
}

bool AreInOneWorld(const std::vector<PosePair>& pairs) {
  return IsDrift(GapOf(pairs), ExtentOf(pairs, &PosePair::truth)) && HaveSameScale(pairs);
}

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

// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/evaluation/trajectory_error.h"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "soslam/evaluation/statistics.h"
#include "soslam/geometry/angles.h"

namespace soslam {

std::map<int, std::vector<PosePair>> PosePairs(const Sequence& sequence,
                                               const std::vector<Rigid3d>& world_from_camera) {
  std::map<int, std::vector<PosePair>> pairs;
  for (size_t i = 0; i < sequence.frames.size(); ++i) {
    const auto& truth = sequence.frames[i].true_world_from_camera;
    std::vector<PosePair>& of_segment = pairs[sequence.frames[i].segment];
    if (truth) of_segment.push_back({world_from_camera[i], *truth});
  }
  return pairs;
}

TrajectoryGap ComputeGap(const std::vector<PosePair>& pairs) {
  std::vector<double> rotations, translations;
  for (const auto& [estimated, truth] : pairs) {
    rotations.push_back(kDegPerRad * estimated.rotation.angularDistance(truth.rotation));
    translations.push_back((estimated.translation - truth.translation).norm());
  }
  return {*MedianOf(rotations), *MedianOf(translations)};
}

double ComputeExtent(const std::vector<PosePair>& pairs, Rigid3d PosePair::*pose) {
  Eigen::AlignedBox3d around;
  for (const PosePair& pair : pairs) around.extend((pair.*pose).translation);
  return around.diagonal().norm();
}

namespace {

// Distance of a camera from the middle of its path (m). Both are medians, which single wrong poses
// do not move.
double MeasureSpread(const std::vector<PosePair>& pairs, Rigid3d PosePair::*pose) {
  Eigen::Vector3d middle;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    middle[axis] = *MedianOf(
        CollectValues(pairs, [&](const PosePair& pair) { return (pair.*pose).translation[axis]; }));
  }
  return *MedianOf(CollectValues(
      pairs, [&](const PosePair& pair) { return ((pair.*pose).translation - middle).norm(); }));
}

}  // namespace

bool HaveSameScale(const std::vector<PosePair>& pairs) {
  constexpr double kLargestRatio = 1.5;
  constexpr double kLeastM = 0.1;
  const double truth = std::max(kLeastM, MeasureSpread(pairs, &PosePair::truth));
  const double estimated = std::max(kLeastM, MeasureSpread(pairs, &PosePair::estimated));
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
  return IsDrift(ComputeGap(pairs), ComputeExtent(pairs, &PosePair::truth)) && HaveSameScale(pairs);
}

Eigen::Matrix3Xd CollectCentres(const std::vector<PosePair>& pairs, Rigid3d PosePair::*pose) {
  Eigen::Matrix3Xd centres(3, pairs.size());
  for (Eigen::Index i = 0; i < centres.cols(); ++i) {
    centres.col(i) = (pairs[i].*pose).translation;
  }
  return centres;
}

double ResidualOfFit(const Eigen::Matrix3Xd& estimated, const Eigen::Matrix3Xd& truth,
                     bool with_scale) {
  const Eigen::Matrix4d truth_from_estimated = Eigen::umeyama(estimated, truth, with_scale);
  const Eigen::Matrix3Xd residuals =
      ((truth_from_estimated.topLeftCorner<3, 3>() * estimated).colwise() +
       Eigen::Vector3d(truth_from_estimated.topRightCorner<3, 1>())) -
      truth;
  return std::sqrt(residuals.squaredNorm() / static_cast<double>(truth.cols()));
}

std::optional<double> AbsoluteTrajectoryError(const std::vector<PosePair>& pairs) {
  if (pairs.size() < 3) return std::nullopt;
  return ResidualOfFit(CollectCentres(pairs, &PosePair::estimated),
                       CollectCentres(pairs, &PosePair::truth),
                       /*with_scale=*/false);
}

}  // namespace soslam

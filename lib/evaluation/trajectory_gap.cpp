// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/trajectory_gap.h"

#include <Eigen/Geometry>
#include <algorithm>

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

// How far a camera is from the middle of its path (m): medians, which single wrong poses do not
// move.
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

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/map_matching.h"

#include <algorithm>
#include <limits>

#include "base/assignment.h"
#include "evaluation/iou.h"
#include "evaluation/landmark_errors.h"
#include "initialisation/semantic_table.h"

namespace soslam {
namespace {

bool IsIn(const Landmark& volume, const Landmark& landmark) {
  const double landmark_m3 = 8.0 * landmark.half_axes.prod();
  return 2.0 * IntersectionVolume(volume, landmark) >= landmark_m3 ||
         BoxIou(volume, landmark) >= kMapIous.front();
}

}  // namespace

Eigen::MatrixXd WorldIous(const Sequence& sequence, const AlignedMap& map) {
  Eigen::MatrixXd ious =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(map.landmarks.size()),
                            static_cast<Eigen::Index>(sequence.true_objects.size()));
  for (Eigen::Index row = 0; row < ious.rows(); ++row) {
    const AlignedLandmark& landmark = map.landmarks[static_cast<size_t>(row)];
    for (Eigen::Index column = 0; column < ious.cols(); ++column) {
      const TrueObject& object = sequence.true_objects[static_cast<size_t>(column)];
      if (!object.IsWanted() || object.segment != landmark.segment) continue;
      const Landmark& truth = object.truth.landmark_in_world;
      const double reach = landmark.landmark_in_world.half_axes.norm() + truth.half_axes.norm();
      if ((landmark.landmark_in_world.Centre() - truth.Centre()).norm() > reach) continue;
      ious(row, column) = CompareLandmarks(landmark.landmark_in_world, object.truth, truth).iou;
    }
  }
  return ious;
}

std::vector<int> MatchByIou(const Eigen::MatrixXd& ious, double min_iou) {
  const Eigen::MatrixXd costs = ious.unaryExpr([&](double iou) {
    return iou >= min_iou ? 1.0 - iou : std::numeric_limits<double>::infinity();
  });
  return Assign(costs, Eigen::VectorXd::Ones(ious.rows()));
}

bool IsIgnored(const Sequence& sequence, const std::string& label,
               const AlignedLandmark& landmark) {
  return std::ranges::any_of(sequence.ignored,
                             [&](const IgnoredThings& things) {
                               if (things.label && !AreSameLabel(*things.label, label)) {
                                 return false;
                               }
                               return !things.volume_in_world ||
                                      IsIn(*things.volume_in_world, landmark.landmark_in_world);
                             }) ||
         std::ranges::any_of(sequence.true_objects, [&](const TrueObject& object) {
           return object.is_static && object.is_ignored && object.segment == landmark.segment &&
                  IsIn(object.truth.landmark_in_world, landmark.landmark_in_world);
         });
}

}  // namespace soslam

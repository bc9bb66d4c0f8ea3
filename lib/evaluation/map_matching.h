// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "evaluation/aligned_map.h"
#include "model/sequence.h"

namespace soslam {

// The intersections over unions from which on a landmark is the true object that it is matched
// with. Rows and reasons are those of the first.
inline constexpr std::array kMapIous = {0.25, 0.5};

// Intersections over unions of boxes in the world: rows are the map's landmarks, columns the true
// objects that stand still, others and those of other segments have 0. Bodies of rotation take the
// landmark's yaw.
Eigen::MatrixXd WorldIous(const Sequence& sequence, const AlignedMap& map);

// The true object of each landmark, or kUnassigned: one to one, so that the sum of their IoUs is
// largest, among pairs with at least this IoU. Labels and ids are not looked at.
std::vector<int> MatchByIou(const Eigen::MatrixXd& ious, double min_iou);

// Whether a landmark that matches no true object is neither right nor wrong: its label is ignored,
// or it is in an ignored volume: half of it, or so much that it would be matched with it.
bool IsIgnored(const std::vector<IgnoredThings>& ignored, const std::string& label,
               const Landmark& landmark_in_world);

}  // namespace soslam

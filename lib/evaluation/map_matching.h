// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "evaluation/aligned_map.h"
#include "model/sequence.h"

namespace soslam {

// Thresholds of IoU above which a landmark matches a true object. Rows and reasons are those of the
// first threshold.
inline constexpr std::array kMapIous = {0.25, 0.5};

// Intersections over unions of boxes in the world: rows are the map's landmarks, columns the true
// objects, of which those that are not looked for and those of other segments have 0. Bodies of
// rotation take the landmark's yaw.
Eigen::MatrixXd WorldIous(const Sequence& sequence, const AlignedMap& map);

// The true object of each landmark, or kUnassigned: one to one, so that the sum of their IoUs is
// maximal, among pairs with at least this IoU. Labels and ids are ignored.
std::vector<int> MatchByIou(const Eigen::MatrixXd& ious, double min_iou);

// Whether a landmark is of things of which nobody says where they are, or that nobody asked for:
// its label is ignored, or it is in the volume of ignored things or of an ignored true object: half
// of it, or so much that it would match a true object there.
bool IsIgnored(const Sequence& sequence, const std::string& label, const AlignedLandmark& landmark);

}  // namespace soslam

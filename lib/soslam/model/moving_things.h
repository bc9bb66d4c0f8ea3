// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "soslam/model/finding.h"
#include "soslam/model/map_points.h"
#include "soslam/model/sequence.h"

namespace soslam {

// For each frame the boxes of things that move, used or not, but those with a score below
// kLeastMovingScore. A point in one of them is no evidence of what stands still.
inline constexpr double kLeastMovingScore = 0.25;
std::vector<std::vector<Box>> BoxesOfMovingThings(const Sequence& sequence);

// The points of which less than half of the image points in frames of the sequence lie in boxes of
// things that move. Pixels are without lens distortion.
std::vector<MapPoint> WithoutMovingThings(const Sequence& sequence, std::vector<MapPoint> points);

// The number of these boxes by label, and of the images that they cover for the most part.
std::vector<Finding> CheckMovingThings(const Sequence& sequence);

}  // namespace soslam

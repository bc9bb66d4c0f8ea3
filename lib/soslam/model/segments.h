// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "soslam/model/sequence.h"

namespace soslam {

// The segments of the frames, each once, in the order of their frames.
std::vector<int> ListSegments(const Sequence& sequence);

// The segment of each object: the only one, or that of its first detection; none if unknown.
std::vector<std::optional<int>> SegmentsOfObjects(const Sequence& sequence);

// The up direction in a segment's world: the normal of that plane of its detections which is
// closest to upright, or upright itself without such planes. Upright is the mean upright direction
// of the segment's images, or z where they look in all directions.
Eigen::Vector3d UpOfSegment(const Sequence& sequence, int segment);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "model/sequence.h"

namespace soslam {

// The segment in which an object was detected.
int SegmentOf(const Sequence& sequence, int object_index);

// The up direction in a segment's world: the normal of that plane of its detections which is
// closest to upright in its images; without such planes, the mean upright direction of its images.
Eigen::Vector3d UpOfSegment(const Sequence& sequence, int segment);

}  // namespace soslam

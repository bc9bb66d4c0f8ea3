// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "geometry/rigid3.h"
#include "model/sequence.h"
#include "planes/up_prior.h"

namespace soslam {

// world_from_camera of each frame, and of each view.
std::vector<Rigid3d> PosesOf(const Sequence& sequence);
std::vector<Rigid3d> PosesOf(const std::vector<SegmentView>& views);

}  // namespace soslam

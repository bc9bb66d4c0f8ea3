// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "model/sequence.h"

namespace soslam {

// The boxes of the frame's other objects that may hide a detection's: those whose foot, where the
// ray through the middle of the box's lower edge meets the object's support plane, is nearer to the
// camera.
std::vector<Box> NearerBoxes(const Sequence& sequence, const Detection& detection);

}  // namespace soslam

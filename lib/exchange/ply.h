// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "exchange/label_colours.h"
#include "exchange/world.h"

namespace soslam {

// The landmarks as one mesh in the world frame, metres, in ASCII PLY: the vertices of each body are
// consecutive, in the colour of its label. `colours` must have all labels of the world.
std::string PlyText(const World& world, const LabelColours& colours);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "exchange/world.h"

namespace soslam {

// Red, green and blue in sRGB, 0 to 1.
using Colour = Eigen::Vector3d;
using LabelColours = std::map<std::string, Colour>;

// A colour for each label of the worlds' objects, clearly different from its alphabetical
// neighbours'.
LabelColours ColoursOfLabels(const std::vector<World>& worlds);

}  // namespace soslam

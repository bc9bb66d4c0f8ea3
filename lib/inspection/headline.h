// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "model/sequence.h"

namespace soslam {

// One line on a map.json, such as "9 objects, 2 of them uncertain, scale +- 18 %": how many objects
// it has, and how well its scale is known by the world.json beside it. It ends with "uncertain: "
// and the reason where something contradicts the scale. Throws InputError.
std::string HeadlineOfMap(const std::filesystem::path& map, const Sequence& sequence);

}  // namespace soslam

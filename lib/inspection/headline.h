// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "model/sequence.h"

namespace soslam {

// One line on a map.json, such as "9 objects, scale +- 18 %, 2 objects uncertain": how many objects
// it has, and how well its scale is known by the world.json beside it, with the reason where
// something contradicts that. Throws InputError.
std::string HeadlineOfMap(const std::filesystem::path& map, const Sequence& sequence);

}  // namespace soslam

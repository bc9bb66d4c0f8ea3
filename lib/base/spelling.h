// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace soslam {

// The known name that a text probably misspells: the one with the fewest letters to insert, remove
// or replace, at most two and less than half of the name (the first of several); none without one.
std::optional<std::string> LikelyMeant(std::string_view text,
                                       const std::vector<std::string>& known);

}  // namespace soslam

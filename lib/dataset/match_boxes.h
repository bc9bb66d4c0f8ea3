// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "geometry/box.h"

namespace soslam {

struct ScoredBox {
  Box box;
  double score = 0.0;
};

// For each found box the index of its given box, if any. One to one and greedy: found boxes in
// order of descending score take the free given box with the largest overlap of at least
// `min_overlap`.
std::vector<std::optional<size_t>> MatchBoxes(const std::vector<ScoredBox>& found,
                                              const std::vector<Box>& given, double min_overlap);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/match_boxes.h"

#include <algorithm>
#include <numeric>

namespace soslam {

std::vector<std::optional<size_t>> MatchBoxes(const std::vector<ScoredBox>& found,
                                              const std::vector<Box>& given, double min_overlap) {
  std::vector<size_t> order(found.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return found[a].score > found[b].score; });
  std::vector<std::optional<size_t>> matches(found.size());
  std::vector<bool> taken(given.size(), false);
  for (const size_t i : order) {
    double best = min_overlap;
    for (size_t k = 0; k < given.size(); ++k) {
      const double overlap = BoxOverlap(found[i].box, given[k]);
      if (taken[k] || overlap < best || (matches[i] && overlap == best)) continue;
      best = overlap;
      matches[i] = k;
    }
    if (matches[i]) taken[*matches[i]] = true;
  }
  return matches;
}

}  // namespace soslam

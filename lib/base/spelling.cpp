// SPDX-License-Identifier: BSD-3-Clause
#include "base/spelling.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace soslam {
namespace {

// Levenshtein distance: number of letters to insert, remove or replace.
size_t Misspellings(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 0; i < a.size(); ++i) {
    size_t diagonal = std::exchange(row[0], i + 1);
    for (size_t k = 0; k < b.size(); ++k) {
      const size_t changed = diagonal + (a[i] == b[k] ? 0 : 1);
      diagonal = row[k + 1];
      row[k + 1] = std::min({row[k] + 1, diagonal + 1, changed});
    }
  }
  return row.back();
}

}  // namespace

std::optional<std::string> LikelyMeant(std::string_view text,
                                       const std::vector<std::string>& known) {
  constexpr size_t kLongest = 64, kMost = 2;
  if (text.size() > kLongest) return std::nullopt;
  std::optional<std::string> likely;
  size_t fewest = kMost + 1;
  for (const std::string& name : known) {
    const size_t misspellings = Misspellings(text, name);
    if (misspellings >= fewest || 2 * misspellings >= name.size()) continue;
    fewest = misspellings;
    likely = name;
  }
  return likely;
}

}  // namespace soslam

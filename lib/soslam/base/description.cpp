// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/base/description.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace soslam {

std::string NotOneOf(const char* field, const std::string& text,
                     const std::vector<std::string>& known) {
  if (std::ranges::find(known, text) != known.end()) return "";
  return fmt::format("{} is \"{}\"; expected {}", field, text, fmt::join(known, " or "));
}

}  // namespace soslam

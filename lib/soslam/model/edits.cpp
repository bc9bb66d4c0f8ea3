// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/model/edits.h"

#include <fmt/format.h>

#include "soslam/base/text.h"

namespace soslam {

std::string InWords(const AppliedEdits& edits) {
  size_t count = 0;
  for (const auto& [kind, of_kind] : edits.kinds) count += static_cast<size_t>(of_kind);
  return fmt::format("{} by hand: {}", Counted(count, "correction"), CountsInWords(edits.kinds));
}

}  // namespace soslam

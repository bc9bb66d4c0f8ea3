// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/error.h"

namespace soslam {

// Maps ids to indices. Files refer to frames, planes and objects by id, code by index in a vector
// sorted by id. `Item` has a member `id`.
template <typename Item>
class IdTable {
 public:
  // `name` is the name of the items in error messages. Throws InputError unless ids ascend.
  IdTable(std::string name, const std::vector<Item>& items) : name_(std::move(name)) {
    for (const Item& item : items) {
      if (!ids_.empty() && item.id <= ids_.back()) {
        throw InputError(fmt::format("{} {} follows {} {}; expected ascending ids", name_, item.id,
                                     name_, ids_.back()));
      }
      ids_.push_back(item.id);
    }
  }

  // Throws InputError when there is no such id.
  int IndexOf(int id) const {
    const auto found = std::lower_bound(ids_.begin(), ids_.end(), id);
    if (found == ids_.end() || *found != id) {
      throw InputError(fmt::format("{} {} is not in the sequence", name_, id));
    }
    return static_cast<int>(found - ids_.begin());
  }

 private:
  std::string name_;
  std::vector<int> ids_;
};

}  // namespace soslam

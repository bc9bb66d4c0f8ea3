// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/frame_lookup.h"

#include <fmt/format.h>

#include <filesystem>
#include <set>

#include "base/error.h"

namespace soslam {

FrameLookup::FrameLookup(const std::vector<ListedImage>& images)
    : size_(static_cast<int>(images.size())) {
  for (int row = 0; row < size_; ++row) {
    const std::filesystem::path path = images[static_cast<size_t>(row)].image;
    const std::set<std::string> names = {path.string(), path.filename().string(),
                                         path.stem().string()};
    for (const std::string& name : names) rows_by_name_[name].push_back(row);
  }
}

std::optional<int> FrameLookup::Find(const FrameKey& key, const std::string& place) const {
  if (const int* row = std::get_if<int>(&key)) {
    return *row >= 0 && *row < size_ ? std::optional(*row) : std::nullopt;
  }
  const std::string& name = std::get<std::string>(key);
  auto found = rows_by_name_.find(name);
  if (found == rows_by_name_.end()) {
    found = rows_by_name_.find(std::filesystem::path(name).filename().string());
  }
  if (found == rows_by_name_.end()) return std::nullopt;
  const std::vector<int>& rows = found->second;
  if (rows.size() > 1) {
    throw InputError(fmt::format("{}: image '{}' could be rows {} of the list; expected one", place,
                                 name, fmt::join(rows, ", ")));
  }
  return rows.front();
}

}  // namespace soslam

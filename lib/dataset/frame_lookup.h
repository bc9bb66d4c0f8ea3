// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dataset/labelled_box.h"
#include "dataset/tum_list.h"

namespace soslam {

// Finds the rows of a list of images that the boxes of a file belong to.
class FrameLookup {
 public:
  explicit FrameLookup(const std::vector<ListedImage>& images);

  // The 0-based row; none when the list has no such image. A name is the path in the list, or the
  // file name without folder, or that without extension. Throws InputError, naming `place`, for a
  // name that several images have.
  std::optional<int> Find(const FrameKey& key, const std::string& place) const;

 private:
  int size_;
  std::map<std::string, std::vector<int>> rows_by_name_;
};

}  // namespace soslam

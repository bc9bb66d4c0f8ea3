// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
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
  // file name without folder, or that without extension. A folder may have another name than in the
  // list, but not that of another camera (cam0 and cam1, left and right). Throws InputError, naming
  // `place`, for a name that several images have, and for names with several folders of one image.
  std::optional<int> Find(const FrameKey& key, const std::string& place);

 private:
  std::vector<std::filesystem::path> folders_;  // by row
  std::map<std::string, std::vector<int>> rows_by_name_;
  std::map<int, std::filesystem::path>
      named_folders_;  // by row, of the first name that was looked up
};

}  // namespace soslam

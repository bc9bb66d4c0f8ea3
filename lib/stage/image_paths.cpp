// SPDX-License-Identifier: BSD-3-Clause
#include "stage/image_paths.h"

#include <fmt/format.h>

#include "base/error.h"

namespace soslam {

namespace fs = std::filesystem;

std::vector<fs::path> ImagePaths(const Sequence& sequence, const fs::path& dataset,
                                 const fs::path& sequence_file) {
  std::vector<fs::path> images;
  for (const Frame& frame : sequence.frames) {
    const fs::path relative = fs::path(frame.image).lexically_normal();
    if (frame.image.empty() || relative.is_absolute() || *relative.begin() == "..") {
      throw InputError(
          fmt::format("{}: frame {}: image is '{}'; expected a path inside the dataset folder",
                      sequence_file.string(), frame.id, frame.image));
    }
    images.push_back(dataset / relative);
  }
  return images;
}

}  // namespace soslam

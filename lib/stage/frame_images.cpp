// SPDX-License-Identifier: BSD-3-Clause
#include "stage/frame_images.h"

#include <fmt/format.h>

#include "base/error.h"
#include "dataset/image_path.h"

namespace soslam {

std::vector<FrameImage> FrameImages(const Sequence& sequence, const StageFiles& files) {
  std::vector<FrameImage> images;
  for (const Frame& frame : sequence.frames) {
    if (frame.image.empty()) continue;
    images.push_back(
        {&frame, ImagePath(files.at("dataset"), frame.image,
                           fmt::format("{}: frame {}", files.at("sequence").string(), frame.id))});
  }
  if (images.empty()) {
    throw NothingUsableError(
        fmt::format("{}: none of its {} frames has an image; expected at least one",
                    files.at("sequence").string(), sequence.frames.size()));
  }
  return images;
}

}  // namespace soslam

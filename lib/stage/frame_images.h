// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "model/sequence.h"
#include "stage/stage_files.h"

namespace soslam {

// A frame of a sequence, which must outlive it, and its image's file in the dataset folder.
struct FrameImage {
  const Frame* frame;
  std::filesystem::path path;
};

// Of the frames that have an image, in their order. Reads files "dataset" and "sequence", the
// latter for messages. Throws InputError for a path that leaves the folder, NothingUsableError when
// no frame has an image.
std::vector<FrameImage> FrameImages(const Sequence& sequence, const StageFiles& files);

}  // namespace soslam

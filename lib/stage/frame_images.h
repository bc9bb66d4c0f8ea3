// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "image/image_undistorter.h"
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

// Reads images as the cameras of a sequence, which must outlive it, would have taken them without
// their lenses.
class FrameImageReader {
 public:
  explicit FrameImageReader(const Sequence& sequence);
  // Grey values, CV_8UC1, of the camera's size. May be called by several threads at once. Throws
  // InputError, also when the file is of another size.
  cv::Mat ReadGrey(const FrameImage& image) const;
  // The same in colour, CV_8UC3.
  cv::Mat ReadColour(const FrameImage& image) const;

 private:
  const Sequence& sequence_;
  std::optional<ImageUndistorter> undistorter_;
};

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "image/read_image.h"
#include "model/sequence.h"

namespace soslam {

// A frame of a sequence, which must outlive this, and the path of its image in the dataset folder.
struct FrameImage {
  const Frame* frame;
  std::filesystem::path path;
};

// All frames that have an image in the folder `dataset`, in order. `sequence_file` is for messages.
// Throws InputError for a path that leaves the folder, NothingUsableError when no frame has an
// image.
std::vector<FrameImage> FrameImages(const Sequence& sequence, const std::filesystem::path& dataset,
                                    const std::filesystem::path& sequence_file);

// Reads undistorted images for the cameras of a sequence, which must outlive it.
class FrameImageReader {
 public:
  explicit FrameImageReader(const Sequence& sequence);
  // Grey image, CV_8UC1, of the camera's size. Thread-safe. Throws InputError, also when the file
  // has another size.
  cv::Mat ReadGrey(const FrameImage& image) const;
  // Colour image, CV_8UC3; otherwise like ReadGrey.
  cv::Mat ReadColour(const FrameImage& image) const;

 private:
  const Sequence& sequence_;
  std::optional<ImageUndistorter> undistorter_;
};

}  // namespace soslam

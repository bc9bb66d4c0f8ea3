// SPDX-License-Identifier: BSD-3-Clause
#include "stage/frame_images.h"

#include <fmt/format.h>

#include "base/error.h"
#include "dataset/image_path.h"

namespace soslam {

namespace fs = std::filesystem;

std::vector<FrameImage> FrameImages(const Sequence& sequence, const fs::path& dataset,
                                    const fs::path& sequence_file) {
  std::vector<FrameImage> images;
  for (const Frame& frame : sequence.frames) {
    if (frame.image.empty()) continue;
    images.push_back(
        {&frame, ImagePath(dataset, frame.image,
                           fmt::format("{}: frame {}", sequence_file.string(), frame.id))});
  }
  if (images.empty()) {
    throw NothingUsableError(
        fmt::format("{}: none of its {} frames has an image; expected at least one",
                    sequence_file.string(), sequence.frames.size()));
  }
  return images;
}

FrameImageReader::FrameImageReader(const Sequence& sequence) : sequence_(sequence) {
  if (sequence.image_distortion) undistorter_.emplace(sequence.camera, *sequence.image_distortion);
}

cv::Mat FrameImageReader::ReadGrey(const FrameImage& image) const {
  const Camera& camera = sequence_.CameraOf(*image.frame);
  const cv::Mat grey =
      ReadGreyImage(image.path, camera.width, camera.height, sequence_.image_orientation);
  return undistorter_ ? undistorter_->Undistort(grey) : grey;
}

cv::Mat FrameImageReader::ReadColour(const FrameImage& image) const {
  const Camera& camera = sequence_.CameraOf(*image.frame);
  const cv::Mat colour =
      ReadColourImage(image.path, camera.width, camera.height, sequence_.image_orientation);
  return undistorter_ ? undistorter_->Undistort(colour) : colour;
}

}  // namespace soslam

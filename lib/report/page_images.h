// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>
#include <string>
#include <vector>

namespace soslam {

// The images of frames (indices into Sequence::frames) in colour, undistorted. `read` throws
// InputError for damaged images.
struct ImageSource {
  std::function<bool(int frame_index)> has;
  std::function<cv::Mat(int frame_index)> read;  // only for frames that have an image
};

// JPEG files in base 64, by frame.
struct EncodedImages {
  struct Image {
    int frame_index;
    std::string base64;
  };
  std::vector<Image> images;
  int scaled_to_px = 0;  // the width; 0 if there was room for the largest
  size_t left_out = 0;   // number of readable images that were left out for lack of room
  std::vector<std::string> failures;  // why other images cannot be read
};

// The images of those frames that have one, in at most max_bytes: scaled down, all alike, as far as
// necessary. If that is not enough, only some of them, evenly spaced.
EncodedImages EncodeImages(const std::vector<int>& frames, const ImageSource& source,
                           size_t max_bytes, int threads);

// A part of a frame's image, px.
struct Crop {
  int frame_index = 0;
  cv::Rect part = {};
};

// JPEG files in base 64 of parts of images, in their order, at most kMaxCropPx wide and high; empty
// where the part is empty, or the frame has no image that can be read.
inline constexpr int kMaxCropPx = 160;
std::vector<std::string> EncodeCrops(const std::vector<Crop>& crops, const ImageSource& source,
                                     int threads);

}  // namespace soslam

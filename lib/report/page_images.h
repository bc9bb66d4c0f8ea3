// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

namespace soslam {

// The images of frames (indices into Sequence::frames) in colour, as their cameras would have taken
// them without their lenses. `read` throws InputError for those that are damaged.
struct ImageSource {
  std::function<bool(int frame_index)> has;
  std::function<cv::Mat(int frame_index)> read;  // where there is one
};

// JPEG files in base 64, by frame.
struct EncodedImages {
  struct Image {
    int frame_index;
    std::string base64;
  };
  std::vector<Image> images;
  int scaled_to_px = 0;               // the width, where there was no room for a larger one
  size_t left_out = 0;                // of those that can be read, for lack of room
  std::vector<std::string> failures;  // why others cannot be read
};

// The images of those frames that have one, in at most max_bytes: scaled down, all alike, as far as
// needed and, when that is not enough, only some of them, evenly over all.
EncodedImages EncodeImages(const std::vector<int>& frames, const ImageSource& source,
                           size_t max_bytes, int threads);

}  // namespace soslam

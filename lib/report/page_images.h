// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

namespace soslam {

// The images of frames (indices into Sequence::frames) in colour, as their cameras would have taken
// them without their lenses.
struct ImageSource {
  std::function<bool(int frame_index)> has;
  std::function<cv::Mat(int frame_index)> read;  // where there is one
};

// JPEG files in base 64 of frames that have images. Images are scaled down, all alike, as far as
// needed for all together to have at most max_bytes.
std::vector<std::string> EncodeImages(const std::vector<int>& frames, const ImageSource& images,
                                      size_t max_bytes, int threads);

}  // namespace soslam

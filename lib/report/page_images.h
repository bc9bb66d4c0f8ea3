// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

namespace soslam {

// The bytes as RFC 4648 has them in base 64.
std::string Base64(const std::vector<unsigned char>& bytes);

// The image of a frame (index into Sequence::frames) in colour, as its camera would have taken it
// without its lens; none where there is none.
using ImageSource = std::function<std::optional<cv::Mat>(int frame_index)>;

// JPEG files in base 64 of those frames that have an image, by position in `frames`; empty for the
// others. Images are scaled down, all alike, as far as needed for all together to have at most
// max_bytes.
std::vector<std::string> EncodeImages(const std::vector<int>& frames, const ImageSource& image_of,
                                      size_t max_bytes, int threads);

}  // namespace soslam

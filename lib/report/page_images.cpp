// SPDX-License-Identifier: BSD-3-Clause
#include "report/page_images.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "base/base64.h"
#include "base/parallel.h"

namespace soslam {
namespace {

constexpr int kJpegQuality = 75;
constexpr std::array kWidthsPx = {800, 640, 480, 320, 200};  // tried in turn

std::string EncodeJpeg(const cv::Mat& image, int max_width) {
  cv::Mat scaled = image;
  if (image.cols > max_width) {
    const double scale = static_cast<double>(max_width) / image.cols;
    cv::resize(image, scaled, {}, scale, scale, cv::INTER_AREA);
  }
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", scaled, bytes, {cv::IMWRITE_JPEG_QUALITY, kJpegQuality});
  return Base64({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace

std::vector<std::string> EncodeImages(const std::vector<int>& frames, const ImageSource& images,
                                      size_t max_bytes, int threads) {
  std::vector<std::string> encoded(frames.size());
  for (const int width : kWidthsPx) {
    ParallelFor(static_cast<int>(frames.size()), threads, [&](int i) {
      const auto index = static_cast<size_t>(i);
      encoded[index] = EncodeJpeg(images.read(frames[index]), width);
    });
    const size_t total =
        std::accumulate(encoded.begin(), encoded.end(), size_t{0},
                        [](size_t sum, const std::string& text) { return sum + text.size(); });
    if (total <= max_bytes) break;
  }
  return encoded;
}

}  // namespace soslam

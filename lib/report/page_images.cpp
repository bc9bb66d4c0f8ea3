// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "base/error.h"
#include "base/hash.h"
#include "base/parallel.h"
#include "report/page_parts.h"

namespace soslam {
namespace {

constexpr int kJpegQuality = 75;
constexpr std::array kWidthsPx = {800, 640, 480, 320, 200};  // tried in turn
constexpr size_t kBytesAround = 64;                          // bytes of the page around each image

// `size`: the width, or the larger of width and height.
cv::Mat Scaled(const cv::Mat& image, int size, int max_size) {
  if (size <= max_size) return image;
  const double scale = static_cast<double>(max_size) / size;
  cv::Mat scaled;
  cv::resize(image, scaled, {}, scale, scale, cv::INTER_AREA);
  return scaled;
}

std::string EncodeJpeg(const cv::Mat& image) {
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", image, bytes, {cv::IMWRITE_JPEG_QUALITY, kJpegQuality});
  return Base64({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace

EncodedImages EncodeImages(const std::vector<int>& frames, const ImageSource& source,
                           size_t max_bytes, int threads) {
  struct LoadedImage {
    int frame_index;
    cv::Mat pixels = {};  // of the largest width that is tried
    std::string failure = {};
  };
  std::vector<LoadedImage> images;
  for (const int frame : frames) {
    if (source.has(frame)) images.push_back({frame});
  }
  ParallelFor(images.size(), threads, [&](size_t i) {
    try {
      const cv::Mat pixels = source.read(images[i].frame_index);
      images[i].pixels = Scaled(pixels, pixels.cols, kWidthsPx.front());
    } catch (const InputError& error) {
      images[i].failure = error.what();
    }
  });
  EncodedImages encoded;
  for (const LoadedImage& image : images) {
    if (!image.failure.empty()) encoded.failures.push_back(image.failure);
  }
  std::erase_if(images, [](const LoadedImage& image) { return !image.failure.empty(); });
  const auto bytes = [&] {
    size_t sum = 0;
    for (const auto& image : encoded.images) sum += image.base64.size() + kBytesAround;
    return sum;
  };
  for (const int width : kWidthsPx) {
    encoded.images.resize(images.size());
    ParallelFor(images.size(), threads, [&](size_t i) {
      const cv::Mat& pixels = images[i].pixels;
      encoded.images[i] = {images[i].frame_index, EncodeJpeg(Scaled(pixels, pixels.cols, width))};
    });
    if (width < kWidthsPx.front()) encoded.scaled_to_px = width;
    if (bytes() <= max_bytes) break;
  }
  while (bytes() > max_bytes) {  // keep every other image
    size_t i = 0;
    std::erase_if(encoded.images, [&](const auto&) { return i++ % 2 == 0; });
  }
  encoded.left_out = images.size() - encoded.images.size();
  return encoded;
}

std::string EncodeCrop(int frame_index, const cv::Rect& part, const ImageSource& source) {
  if (part.empty() || !source.has(frame_index)) return "";
  try {
    const cv::Mat image = source.read(frame_index);
    const cv::Mat crop = image(part & cv::Rect(0, 0, image.cols, image.rows));
    if (crop.empty()) return "";
    return EncodeJpeg(Scaled(crop, std::max(crop.cols, crop.rows), kMaxCropPx));
  } catch (const InputError&) {  // EncodeImages says which images cannot be read
    return "";
  }
}

}  // namespace soslam

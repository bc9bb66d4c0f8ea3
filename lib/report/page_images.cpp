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

// The image of a frame, of the largest width that is tried, or why it cannot be read.
struct LoadedImage {
  int frame_index = 0;
  cv::Mat pixels = {};
  std::string failure = {};
};

std::vector<LoadedImage> LoadAll(const std::vector<int>& frames, const ImageSource& source,
                                 int threads) {
  std::vector<LoadedImage> images;
  for (const int frame : frames) {
    if (source.has(frame)) images.push_back({frame});
  }
  ParallelFor(images.size(), threads, [&](size_t i) {
    LoadedImage& image = images[i];
    try {
      const cv::Mat pixels = source.read(image.frame_index);
      image.pixels = Scaled(pixels, pixels.cols, kWidthsPx.front());
    } catch (const InputError& error) {
      image.failure = error.what();
    }
  });
  return images;
}

std::vector<EncodedImages::Image> EncodeAll(const std::vector<LoadedImage>& images, int width,
                                            int threads) {
  std::vector<EncodedImages::Image> encoded(images.size());
  ParallelFor(images.size(), threads, [&](size_t i) {
    const auto& [frame_index, pixels, failure] = images[i];
    encoded[i] = {frame_index, EncodeJpeg(Scaled(pixels, pixels.cols, width))};
  });
  return encoded;
}

size_t TotalBytes(const std::vector<EncodedImages::Image>& images) {
  size_t bytes = 0;
  for (const auto& image : images) bytes += image.base64.size() + kBytesAround;
  return bytes;
}

}  // namespace

EncodedImages EncodeImages(const std::vector<int>& frames, const ImageSource& source,
                           size_t max_bytes, int threads) {
  std::vector<LoadedImage> images = LoadAll(frames, source, threads);
  EncodedImages encoded;
  for (const LoadedImage& image : images) {
    if (!image.failure.empty()) encoded.failures.push_back(image.failure);
  }
  std::erase_if(images, [](const LoadedImage& image) { return !image.failure.empty(); });
  for (const int width : kWidthsPx) {
    encoded.images = EncodeAll(images, width, threads);
    if (width < kWidthsPx.front()) encoded.scaled_to_px = width;
    if (TotalBytes(encoded.images) <= max_bytes) break;
  }
  while (TotalBytes(encoded.images) > max_bytes) {  // keep every other image
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

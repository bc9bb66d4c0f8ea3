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

struct ReadImages {
  std::vector<int> frames;
  std::vector<cv::Mat> images;  // of the largest width that is tried
  std::vector<std::string> failures;
};

ReadImages ReadAll(std::vector<int> frames, const ImageSource& source, int threads) {
  std::erase_if(frames, std::not_fn(source.has));
  std::vector<cv::Mat> images(frames.size());
  std::vector<std::string> failures(frames.size());
  ParallelFor(static_cast<int>(frames.size()), threads, [&](int i) {
    const auto index = static_cast<size_t>(i);
    try {
      const cv::Mat image = source.read(frames[index]);
      images[index] = Scaled(image, image.cols, kWidthsPx.front());
    } catch (const InputError& error) {
      failures[index] = error.what();
    }
  });
  ReadImages read;
  for (size_t i = 0; i < frames.size(); ++i) {
    if (failures[i].empty()) {
      read.frames.push_back(frames[i]);
      read.images.push_back(images[i]);
    } else {
      read.failures.push_back(failures[i]);
    }
  }
  return read;
}

std::vector<EncodedImages::Image> EncodeAll(const ReadImages& read, int width, int threads) {
  std::vector<EncodedImages::Image> encoded(read.frames.size());
  ParallelFor(static_cast<int>(encoded.size()), threads, [&](int i) {
    const auto index = static_cast<size_t>(i);
    encoded[index] = {read.frames[index],
                      EncodeJpeg(Scaled(read.images[index], read.images[index].cols, width))};
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
  ReadImages read = ReadAll(frames, source, threads);
  EncodedImages encoded;
  for (const int width : kWidthsPx) {
    encoded.images = EncodeAll(read, width, threads);
    if (width < kWidthsPx.front()) encoded.scaled_to_px = width;
    if (TotalBytes(encoded.images) <= max_bytes) break;
  }
  while (TotalBytes(encoded.images) > max_bytes) {  // keep every other image
    size_t i = 0;
    std::erase_if(encoded.images, [&](const auto&) { return i++ % 2 == 0; });
  }
  encoded.left_out = read.frames.size() - encoded.images.size();
  encoded.failures = std::move(read.failures);
  return encoded;
}

std::string EncodeCrop(const Crop& crop, const ImageSource& source) {
  if (crop.part.empty() || !source.has(crop.frame_index)) return "";
  try {
    const cv::Mat image = source.read(crop.frame_index);
    const cv::Mat part = image(crop.part & cv::Rect(0, 0, image.cols, image.rows));
    if (part.empty()) return "";
    return EncodeJpeg(Scaled(part, std::max(part.cols, part.rows), kMaxCropPx));
  } catch (const InputError&) {  // EncodeImages says which images cannot be read
    return "";
  }
}

}  // namespace soslam

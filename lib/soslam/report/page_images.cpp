// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "soslam/base/error.h"
#include "soslam/base/parallel.h"
#include "soslam/report/page_html.h"
#include "soslam/report/page_parts.h"
#include "soslam/system/hash.h"

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

Picture PictureOfBox(int frame_index, const Box& box, const Camera& camera) {
  constexpr double kMargin = 0.15, kMaxAspect = 1.6, kMinAspect = 0.6;
  const double margin = kMargin * std::max(box.Width(), box.Height());
  double width = box.Width() + 2.0 * margin, height = box.Height() + 2.0 * margin;
  height = std::max(height, width / kMaxAspect);
  width = std::max(width, height * kMinAspect);
  const Eigen::Vector2d centre = box.Centre();
  const auto inside = [](double pixel, int size) {
    return static_cast<int>(std::clamp(std::round(pixel), 0.0, static_cast<double>(size)));
  };
  return {frame_index,
          {cv::Point(inside(centre.x() - 0.5 * width, camera.width),
                     inside(centre.y() - 0.5 * height, camera.height)),
           cv::Point(inside(centre.x() + 0.5 * width, camera.width),
                     inside(centre.y() + 0.5 * height, camera.height))},
          CornersOf(box)};
}

void AddJpegs(const std::vector<Picture*>& pictures, int max_px, const ImageSource& source,
              int threads) {
  std::map<int, std::vector<Picture*>> by_frame;
  for (Picture* picture : pictures) {
    if (!picture->part.empty() && source.has(picture->frame_index)) {
      by_frame[picture->frame_index].push_back(picture);
    }
  }
  const std::vector<std::pair<int, std::vector<Picture*>>> frames(by_frame.begin(), by_frame.end());
  ParallelFor(frames.size(), threads, [&](size_t i) {
    try {
      const cv::Mat image = source.read(frames[i].first);
      for (Picture* picture : frames[i].second) {
        const cv::Mat crop = image(picture->part & cv::Rect(0, 0, image.cols, image.rows));
        if (crop.empty()) continue;
        picture->jpeg = EncodeJpeg(Scaled(crop, std::max(crop.cols, crop.rows), max_px));
      }
    } catch (const InputError&) {  // EncodeImages says which images cannot be read
    }
  });
}

std::string PictureSvg(const Picture& picture, const std::string& name, const std::string& id) {
  const cv::Rect& part = picture.part;
  std::string points;
  for (const Eigen::Vector2d& pixel : picture.outline) {
    points += fmt::format("{:.1f},{:.1f} ", pixel.x() + 0.5 - part.x, pixel.y() + 0.5 - part.y);
  }
  const std::string image =
      picture.jpeg.empty()
          ? ""
          : fmt::format("<image width=\"{}\" height=\"{}\" href=\"data:image/jpeg;base64,{}\"/>",
                        part.width, part.height, picture.jpeg);
  // The inner element is what plans show as well.
  return fmt::format(
      "<svg class=\"picture\" viewBox=\"0 0 {0} {1}\" role=\"img\" aria-label=\"{2}\">"
      "<svg {3}class=\"on-image\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\">{4}"
      "<polygon class=\"{5}\" points=\"{6}\"/></svg></svg>",
      part.width, part.height, HtmlText(name), id.empty() ? "" : fmt::format("id=\"{}\" ", id),
      image, picture.is_body ? "estimate" : "detection", points);
}

}  // namespace soslam

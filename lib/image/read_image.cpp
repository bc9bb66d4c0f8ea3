// SPDX-License-Identifier: BSD-3-Clause
#include "image/read_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/run_log.h"
#include "geometry/image_size.h"
#include "image/image_header.h"

namespace soslam {
namespace {

using namespace std::string_view_literals;

std::vector<char> ReadBytes(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) {
    throw InputError(fmt::format("{}: no such file; expected an image", path.string()));
  }
  NoteInput(path);
  std::ifstream stream(path, std::ios::binary | std::ios::ate);  // whose place is its size
  std::vector<char> bytes(static_cast<size_t>(std::max<std::streamoff>(0, stream.tellg())));
  stream.seekg(0).read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!stream) throw InputError(fmt::format("{}: cannot be read", path.string()));
  if (bytes.empty()) {
    throw InputError(fmt::format("{}: is empty; expected an image", path.string()));
  }
  return bytes;
}

// libjpeg fills what is missing with grey and libpng may do the same, both without an error. Some
// writers pad with zeros after the end, so those do not count.
void CheckComplete(std::string_view bytes, const std::filesystem::path& path) {
  const size_t last = bytes.find_last_not_of('\0');
  const std::string_view unpadded = bytes.substr(0, last == bytes.npos ? 0 : last + 1);
  if (bytes.starts_with("\xff\xd8\xff"sv) && !unpadded.ends_with("\xff\xd9"sv)) {
    throw InputError(
        fmt::format("{}: is cut short after {} bytes; expected a JPEG image that ends "
                    "with the marker EOI",
                    path.string(), bytes.size()));
  }
  if (bytes.starts_with("\x89PNG\r\n\x1a\n"sv) && !unpadded.ends_with("IEND\xae\x42\x60\x82"sv)) {
    throw InputError(
        fmt::format("{}: is cut short after {} bytes; expected a PNG image that ends "
                    "with the chunk IEND",
                    path.string(), bytes.size()));
  }
}

// Before anything of that size is allocated.
void CheckSize(std::string_view bytes, const std::filesystem::path& path) {
  const auto size = SizeInHeader(bytes);
  if (!size) {
    throw InputError(path.string() + ": cannot be decoded; expected a PNG or JPEG image");
  }
  if (!IsImageSize(size->width, size->height)) {
    throw InputError(fmt::format("{}: is {} x {} pixels; expected at most {} in all", path.string(),
                                 size->width, size->height, kMaxPixels));
  }
}

// `mode` is OpenCV's IMREAD_GRAYSCALE or IMREAD_COLOR.
cv::Mat ReadImage(const std::filesystem::path& path, int mode) {
  const std::vector<char> bytes = ReadBytes(path);
  CheckSize({bytes.data(), bytes.size()}, path);
  CheckComplete({bytes.data(), bytes.size()}, path);
  cv::Mat image;
  try {
    image = cv::imdecode(bytes, mode | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception& error) {
    throw InputError(fmt::format("{}: cannot be decoded: {}", path.string(), error.err));
  }
  if (image.empty()) {
    throw InputError(fmt::format("{}: cannot be decoded; expected an image", path.string()));
  }
  return image;
}

cv::Mat OfSize(const cv::Mat& image, int width, int height, const std::filesystem::path& path) {
  if (image.cols != width || image.rows != height) {
    throw InputError(fmt::format("{}: is {} x {} pixels; expected the camera's {} x {}",
                                 path.string(), image.cols, image.rows, width, height));
  }
  return image;
}

}  // namespace

cv::Mat ReadGreyImage(const std::filesystem::path& path) {
  return ReadImage(path, cv::IMREAD_GRAYSCALE);
}

cv::Mat ReadColourImage(const std::filesystem::path& path) {
  return ReadImage(path, cv::IMREAD_COLOR);
}

cv::Mat ReadGreyImage(const std::filesystem::path& path, int width, int height) {
  return OfSize(ReadGreyImage(path), width, height, path);
}

cv::Mat ReadColourImage(const std::filesystem::path& path, int width, int height) {
  return OfSize(ReadColourImage(path), width, height, path);
}

}  // namespace soslam

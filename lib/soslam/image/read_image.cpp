// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/image/read_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/core/eigen.hpp>
#include <opencv2/imgproc.hpp>
#include <string_view>
#include <utility>
#include <vector>

#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/image/file_kind.h"
#include "soslam/image/image_turn.h"
#include "soslam/system/run_log.h"

namespace soslam {
namespace {

std::vector<char> ReadBytes(const std::filesystem::path& path) {
  if (!IsFile(path)) {
    throw InputError(fmt::format("{}: no such file; expected an image", path.string()));
  }
  RecordInput(path);
  std::ifstream stream(
      path, std::ios::binary | std::ios::ate);  // opened at its end, which gives the size
  const std::streamoff size = std::max<std::streamoff>(0, stream.tellg());
  constexpr std::streamoff kMaxSize = std::numeric_limits<int>::max();  // limit of OpenCV's decoder
  if (size > kMaxSize) {
    throw InputError(fmt::format("{}: has {} bytes; expected an image of at most {}", path.string(),
                                 size, kMaxSize));
  }
  std::vector<char> bytes(static_cast<size_t>(size));
  stream.seekg(0).read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!stream) throw InputError(fmt::format("{}: cannot be read", path.string()));
  if (bytes.empty()) {
    throw InputError(fmt::format("{}: is empty; expected an image", path.string()));
  }
  return bytes;
}

constexpr const char* kFormats = "JPEG, PNG, WebP, BMP or TIFF";

constexpr const char* kOtherContent[] = {  // in the order of OtherContent
    ("is a RAW photo, which is not read; expected the JPEG that the camera wrote with it, or one "
     "developed from it"),
    "has several images; expected one: tiffsplit makes a file of each",
    "is an animation; expected one image"};

// The format and header of an image that can be decoded. Checks a file before anything of its size
// is allocated, and cuts `bytes` at the image's end.
std::pair<const ImageFormat*, ImageHeader> Check(const std::filesystem::path& path,
                                                 std::vector<char>* bytes) {
  const std::string_view file(bytes->data(), bytes->size());
  if (const auto other = FindOtherContent(path, ImageBytes(file))) {
    throw InputError(
        fmt::format("{}: {}", path.string(), kOtherContent[static_cast<size_t>(*other)]));
  }
  const ImageFormat* format = FindImageFormat(file.substr(0, kSignatureSize));
  if (format == nullptr) {
    const std::string kind = FileKind(file);
    throw InputError(fmt::format("{}: {}; expected a {} image", path.string(),
                                 kind.empty() ? "cannot be decoded" : "is " + kind, kFormats));
  }
  const auto header = format->header(ImageBytes(file));
  if (header && !IsImageSize(header->stored.width, header->stored.height)) {
    throw InputError(fmt::format("{}: is {} x {} pixels; expected at most {} in all", path.string(),
                                 header->stored.width, header->stored.height, kMaxPixels));
  }
  const auto length = format->length == nullptr ? std::optional(file.size()) : format->length(file);
  if (!length) {
    throw InputError(fmt::format("{}: is cut short after {} bytes; expected a {} image {}",
                                 path.string(), file.size(), format->name, format->whole));
  }
  if (!header) {
    throw InputError(fmt::format("{}: cannot be decoded; expected a {} image of a usual kind",
                                 path.string(), format->name));
  }
  bytes->resize(*length);
  return {format, *header};
}

}  // namespace

cv::Mat ReadImage(const std::filesystem::path& path, int mode, ImageOrientation orientation,
                  const std::optional<cv::Size>& size) {
  std::vector<char> bytes = ReadBytes(path);
  const auto [format, header] = Check(path, &bytes);
  if (format->clear_orientation != nullptr) format->clear_orientation(bytes);
  // OpenCV 4.6 decodes WebP from unsigned bytes only.
  const cv::Mat encoded(1, static_cast<int>(bytes.size()), CV_8UC1, bytes.data());
  cv::Mat stored;
  try {
    stored = cv::imdecode(encoded, mode | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception& error) {
    throw InputError(fmt::format("{}: cannot be decoded: {}", path.string(), error.err));
  }
  if (stored.cols != header.stored.width || stored.rows != header.stored.height) {
    throw InputError(fmt::format(
        "{}: cannot be decoded; expected an intact {} image, not one cut short or of a rare kind",
        path.string(), format->name));
  }
  const bool is_upright = orientation == ImageOrientation::kUpright;
  cv::Mat image = is_upright ? Turned(stored, ExifTurn(header.orientation)) : stored;
  if (!size || image.size() == *size) return image;
  std::string hint;
  if (header.IsTurnedByAQuarter() && image.cols == size->height && image.rows == size->width) {
    hint = fmt::format(
        ": does the camera refer to the {}? EXIF says orientation {}; image_orientation of "
        "soslam-import is {}",
        is_upright ? "stored pixels" : "upright image", header.orientation,
        kImageOrientationNames[static_cast<size_t>(orientation)]);
  }
  throw InputError(fmt::format("{}: is {} x {} pixels; expected the camera's {} x {}{}",
                               path.string(), image.cols, image.rows, size->width, size->height,
                               hint));
}

ImageUndistorter::ImageUndistorter(const Camera& camera, const Distortion& distortion) {
  cv::Matx33d intrinsics;
  cv::eigen2cv(camera.Intrinsics(), intrinsics);
  cv::initUndistortRectifyMap(intrinsics, DistortionCoefficients(distortion), cv::noArray(),
                              intrinsics, {camera.width, camera.height}, CV_32FC1, source_x_,
                              source_y_);
}

cv::Mat ImageUndistorter::Undistort(const cv::Mat& distorted) const {
  cv::Mat undistorted;
  cv::remap(distorted, undistorted, source_x_, source_y_, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return undistorted;
}

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#include "image/video_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <opencv2/videoio.hpp>
#include <string>
#include <string_view>

#include "base/error.h"
#include "base/paths.h"
#include "base/run_log.h"
#include "geometry/image_size.h"
#include "image/image_format.h"

namespace soslam {
namespace {

using namespace std::string_view_literals;

constexpr const char* kFormats = "a video: MP4, MOV, AVI, MKV or WebM";

// True if the first bytes are those of a video: MP4, MOV and relatives, AVI, Matroska, WebM. Lists
// of other files, which decoders would follow, are none.
bool IsVideo(std::string_view first_bytes) {
  const std::string_view at_4 = first_bytes.substr(std::min<size_t>(4, first_bytes.size()), 4);
  const bool is_quicktime = at_4 == "ftyp" || at_4 == "moov" || at_4 == "mdat" || at_4 == "wide";
  const bool is_avi = first_bytes.starts_with("RIFF") && first_bytes.ends_with("AVI ");
  return is_quicktime || is_avi || first_bytes.starts_with("\x1a\x45\xdf\xa3"sv);
}

}  // namespace

VideoReader::VideoReader(const std::filesystem::path& path) : path_(path) {
  if (!IsFile(path)) {
    throw InputError(fmt::format("{}: no such file; expected {}", path.string(), kFormats));
  }
  RecordInput(path);
  if (!IsVideo(ImageBytes::OfFile(path).UpTo(0, kSignatureSize))) {
    throw InputError(
        fmt::format("{}: is no video that can be read; expected {}", path.string(), kFormats));
  }
  // AV_LOG_QUIET: FFmpeg's own messages do not name the file. Missing frames show in
  // announced_frames().
  ::setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", /*overwrite=*/0);
  // FFmpeg takes relative names with a colon for addresses.
  capture_ = std::make_unique<cv::VideoCapture>(PlainPath(path).string(), cv::CAP_FFMPEG);
  const auto width = static_cast<int>(capture_->get(cv::CAP_PROP_FRAME_WIDTH));
  const auto height = static_cast<int>(capture_->get(cv::CAP_PROP_FRAME_HEIGHT));
  if (!capture_->isOpened() || !IsImageSize(width, height)) {
    throw InputError(fmt::format(
        "{}: cannot be opened; expected {}: is it cut short, or packed in an unusual way? Try "
        "ffmpeg -i VIDEO -q:v 2 FOLDER/%06d.jpg, and give the folder",
        path.string(), kFormats));
  }
  const double rate = capture_->get(cv::CAP_PROP_FPS);
  frame_duration_s_ = std::isfinite(rate) && rate > 0.0 ? 1.0 / rate : 1.0 / 30.0;
}

VideoReader::~VideoReader() = default;

bool VideoReader::Next() {
  constexpr int kMaxFrames = 20'000;
  if (!capture_->read(image_) || image_.empty()) return false;
  if (++frames_ > kMaxFrames) {
    throw InputError(
        fmt::format("{}: has more than {} frames; expected a shorter one, or one with fewer frames "
                    "per second",
                    path_.string(), kMaxFrames));
  }
  const double time_s = capture_->get(cv::CAP_PROP_POS_MSEC) / 1000.0;
  const double next_s = frames_ == 1 ? 0.0 : time_s_ + frame_duration_s_;
  time_s_ = std::isfinite(time_s) && time_s > time_s_ ? time_s : next_s;
  return true;
}

int VideoReader::announced_frames() const {
  const double count = capture_->get(cv::CAP_PROP_FRAME_COUNT);
  return count > 0.0 && count < 1e9 ? static_cast<int>(count) : 0;
}

}  // namespace soslam

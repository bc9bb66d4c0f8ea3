// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <opencv2/core/mat.hpp>

namespace cv {
class VideoCapture;
}

namespace soslam {

// Reads the frames of a video from the first to the last, upright: MP4, MOV and relatives, AVI,
// Matroska, WebM.
class VideoReader {
 public:
  // Throws InputError for a file that is missing, no such video, or has no frame that can be
  // decoded.
  explicit VideoReader(const std::filesystem::path& path);
  ~VideoReader();

  // Decodes the next frame; false after the last. Throws InputError for a video of more frames than
  // can be processed.
  bool Next();
  // The frame, CV_8UC3: blue, green, red. Valid until the next call of Next.
  const cv::Mat& image() const { return image_; }
  // Time since the first frame; ascends.
  double time_s() const { return time_s_; }
  // Number of frames that the file announces; 0 if it does not.
  int announced_frames() const;

 private:
  std::filesystem::path path_;
  std::unique_ptr<cv::VideoCapture> capture_;
  double frame_duration_s_;
  cv::Mat image_;
  int frames_ = 0;  // decoded so far
  double time_s_ = 0.0;
};

}  // namespace soslam

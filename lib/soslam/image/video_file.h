// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>

namespace soslam {

// Reads the frames of a video from the first to the last, as players show them: upright, with
// square pixels, without what an edit list hides. MP4, MOV and relatives, AVI, Matroska, WebM; of
// several video streams the one with the largest frames, among equals the first.
class VideoReader {
 public:
  // Throws InputError for a file that is missing, no such video, of a codec without a decoder, or
  // to be turned by other than quarters.
  explicit VideoReader(const std::filesystem::path& path);
  ~VideoReader();

  // Decodes the next frame; false after the last. Throws InputError for a video of more frames than
  // can be processed, or to be turned by other than quarters from here on.
  bool Next();
  // The frame, by mode as ReadImage; valid until the next call. Throws InputError for a frame that
  // is larger than can be processed.
  cv::Mat Image(int mode);
  // Time since the first frame; ascends.
  double time_s() const { return time_s_; }
  // True if a part of the frame is lost, or of a frame that it is predicted from.
  bool is_damaged() const { return is_damaged_; }
  // Number of frames in the duration that the file announces; 0 if it does not.
  int announced_frames() const;

  // After the last frame: true if the decoder met with an error.
  bool has_errors() const { return has_errors_; }
  // After the last frame: true if the file ends within a packet, or a tenth earlier than it
  // announces for pictures or sound.
  bool is_cut_short() const;
  // The angle in the tag `rotate`, by which older programs turned videos, where it is the only one;
  // players ignore it. Otherwise empty.
  std::string ignored_rotation() const;

 private:
  struct Decoder;

  bool ReadPacket();

  std::filesystem::path path_;
  std::unique_ptr<Decoder> decoder_;
  double frame_duration_s_;
  double announced_s_ = 0.0;  // duration of pictures and sound of which there are packets so far
  double end_s_ = 0.0;        // of the last packet so far
  std::int64_t first_stamp_ = 0;
  int frames_ = 0;  // decoded so far
  double time_s_ = 0.0;
  bool is_at_end_ = false;  // no packet is left
  bool is_damaged_ = false;
  bool ends_within_packet_ = false;
  bool has_errors_ = false;
};

}  // namespace soslam

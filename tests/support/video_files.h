// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <filesystem>
#include <opencv2/core.hpp>
#include <stdexcept>
#include <string>
#include <vector>

extern "C" {
#include <libavformat/avformat.h>
}

#include "support/image_files.h"

namespace soslam {

struct VideoTrack {
  std::vector<cv::Mat> frames;
  std::vector<int> times = {};  // tenths of a second; 0, 1, 2, ... if there are none
  AVRational pixel_aspect = {1, 1};
  std::string rotate_tag = {};
};

// Writes a video of ten frames a second, Motion JPEG, in the format of its name, with the index at
// the front. Frames of MOV before the time 0 are hidden by an edit list.
inline void WriteVideo(const std::filesystem::path& path, const std::vector<VideoTrack>& tracks) {
  const AVRational tenth = {1, 10};
  av_log_set_level(AV_LOG_ERROR);
  AVFormatContext* format = nullptr;
  avformat_alloc_output_context2(&format, nullptr, nullptr, path.c_str());
  for (const VideoTrack& track : tracks) {
    AVStream& stream = *avformat_new_stream(format, nullptr);
    stream.time_base = tenth;
    stream.avg_frame_rate = {10, 1};
    stream.sample_aspect_ratio = track.pixel_aspect;
    if (!track.rotate_tag.empty()) {
      av_dict_set(&stream.metadata, "ROTATE", track.rotate_tag.c_str(), 0);
    }
    AVCodecParameters& codec = *stream.codecpar;
    codec.codec_type = AVMEDIA_TYPE_VIDEO;
    codec.codec_id = AV_CODEC_ID_MJPEG;
    codec.format = AV_PIX_FMT_YUVJ420P;
    codec.width = track.frames.front().cols;
    codec.height = track.frames.front().rows;
    codec.sample_aspect_ratio = track.pixel_aspect;
  }
  AVDictionary* options = nullptr;
  av_dict_set(&options, "movflags", "faststart", 0);
  if (avio_open(&format->pb, ("file:" + path.string()).c_str(), AVIO_FLAG_WRITE) < 0 ||
      avformat_write_header(format, &options) < 0) {
    throw std::runtime_error("cannot write " + path.string());
  }
  av_dict_free(&options);
  AVPacket* packet = av_packet_alloc();
  for (size_t index = 0; index < tracks.size(); ++index) {
    const VideoTrack& track = tracks[index];
    for (size_t i = 0; i < track.frames.size(); ++i) {
      const std::string jpeg = EncodedImage(".jpg", track.frames[i]);
      av_new_packet(packet, static_cast<int>(jpeg.size()));
      std::ranges::copy(jpeg, packet->data);
      packet->stream_index = static_cast<int>(index);
      packet->flags = AV_PKT_FLAG_KEY;
      packet->pts = packet->dts = track.times.empty() ? static_cast<int>(i) : track.times[i];
      packet->duration = 1;
      av_packet_rescale_ts(packet, tenth, format->streams[index]->time_base);
      av_interleaved_write_frame(format, packet);
    }
  }
  av_packet_free(&packet);
  av_write_trailer(format);
  avio_closep(&format->pb);
  avformat_free_context(format);
}

// The display matrix of a turn, as MP4 stores it: the images of the x and y axes.
struct DisplayAxes {
  double x_x, x_y, y_x, y_y;
};

// Gives the first track of an MP4 or MOV file, which has none, a display matrix.
inline std::string WithDisplayMatrix(std::string video, const DisplayAxes& axes) {
  const auto matrix_of = [](const DisplayAxes& a) {
    std::string bytes;
    for (const double number : {a.x_x, a.x_y, 0.0, a.y_x, a.y_y, 0.0, 0.0, 0.0, 16384.0}) {
      bytes += NumberBytes(static_cast<std::uint64_t>(std::llround(65536.0 * number)), 4,
                           ByteOrder::kBigEndian);
    }
    return bytes;
  };
  const std::string none = matrix_of({1.0, 0.0, 0.0, 1.0});
  return video.replace(video.find(none, video.find("tkhd")), none.size(), matrix_of(axes));
}

}  // namespace soslam

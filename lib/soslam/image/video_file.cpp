// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/image/video_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/display.h>
#include <libswscale/swscale.h>
}

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/geometry/image_size.h"
#include "soslam/image/file_kind.h"
#include "soslam/image/image_format.h"
#include "soslam/image/image_turn.h"
#include "soslam/system/run_log.h"

namespace soslam {
namespace {

using namespace std::string_view_literals;

constexpr const char* kFormats = "a video: MP4, MOV, AVI, MKV or WebM";
constexpr const char* kByFfmpeg = "Try ffmpeg -i VIDEO -q:v 2 FOLDER/%06d.jpg, and give the folder";

// True if the first bytes are those of a video: MP4, MOV and relatives, AVI, Matroska, WebM. Lists
// of other files, which decoders would follow, are none.
bool IsVideo(std::string_view first_bytes) {
  const std::string_view at_4 = first_bytes.substr(std::min<size_t>(4, first_bytes.size()), 4);
  const bool is_quicktime = at_4 == "ftyp" || at_4 == "moov" || at_4 == "mdat" || at_4 == "wide";
  const bool is_avi = first_bytes.starts_with("RIFF") && first_bytes.ends_with("AVI ");
  return is_quicktime || is_avi || first_bytes.starts_with("\x1a\x45\xdf\xa3"sv);
}

// True unless the stream is of another type, or cover art.
bool IsOfFrames(const AVStream& stream) {
  return stream.codecpar->codec_type == AVMEDIA_TYPE_VIDEO &&
         (stream.disposition & AV_DISPOSITION_ATTACHED_PIC) == 0;
}

// The duration that a file announces for a stream, or, as MKV, for all; in seconds, 0 if it does
// not.
double AnnouncedDuration(const AVFormatContext& format, const AVStream& stream) {
  const bool is_guess = format.duration_estimation_method == AVFMT_DURATION_FROM_BITRATE;
  const bool is_own = stream.duration != AV_NOPTS_VALUE;
  if (is_guess || (!is_own && format.duration == AV_NOPTS_VALUE)) return 0.0;
  return is_own ? static_cast<double>(stream.duration) * av_q2d(stream.time_base)
                : static_cast<double>(format.duration) / AV_TIME_BASE;
}

// The matrix that says how the frames of a stream are shown; null if there is none.
const std::uint8_t* DisplayMatrix(const AVStream& stream) {
#if LIBAVCODEC_VERSION_INT >= AV_VERSION_INT(60, 31, 102)  // FFmpeg 6.1
  const AVPacketSideData* data =
      av_packet_side_data_get(stream.codecpar->coded_side_data, stream.codecpar->nb_coded_side_data,
                              AV_PKT_DATA_DISPLAYMATRIX);
  return data == nullptr ? nullptr : data->data;
#else
  return av_stream_get_side_data(&stream, AV_PKT_DATA_DISPLAYMATRIX, nullptr);
#endif
}

// Throws InputError for rotations by other than quarters of a full turn, to a degree.
ImageTurn ReadTurn(const std::uint8_t* display_matrix, const std::string& place) {
  constexpr double kTan1Deg = 0.017;
  const auto* matrix = reinterpret_cast<const std::int32_t*>(display_matrix);
  const auto at = [&](int index) { return static_cast<double>(matrix[index]); };
  const double x_x = at(0), x_y = at(1), y_x = at(3), y_y = at(4);  // images of both axes
  const bool is_transposed = std::abs(x_y) > std::abs(x_x);
  const auto is_along = [](double main, double other) {
    return std::abs(other) <= kTan1Deg * std::abs(main);
  };
  if (is_transposed ? !is_along(x_y, x_x) || !is_along(y_x, y_y)
                    : !is_along(x_x, x_y) || !is_along(y_y, y_x)) {
    throw InputError(
        fmt::format("{}: is to be shown turned by {:.0f} degrees; expected a multiple of 90. {}",
                    place, -av_display_rotation_get(matrix), kByFfmpeg));
  }
  return is_transposed ? ImageTurn{true, y_x < 0.0, x_y < 0.0}
                       : ImageTurn{false, x_x < 0.0, y_y < 0.0};
}

}  // namespace

// The state of FFmpeg's libraries for a video.
struct VideoReader::Decoder {
  AVFormatContext* format = nullptr;
  AVStream* stream = nullptr;  // of `format`
  AVCodecContext* codec = nullptr;
  AVPacket* packet = av_packet_alloc();
  AVFrame* frame = av_frame_alloc();
  AVFrame* converted = av_frame_alloc();
  SwsContext* converter = nullptr;
  std::optional<ImageTurn> turn = {};  // none without a display matrix

  ~Decoder() {
    sws_freeContext(converter);
    av_frame_free(&converted);
    av_frame_free(&frame);
    av_packet_free(&packet);
    avcodec_free_context(&codec);
    avformat_close_input(&format);
  }
};

VideoReader::VideoReader(const std::filesystem::path& path)
    : path_(path), decoder_(std::make_unique<Decoder>()) {
  if (!IsFile(path)) {
    throw InputError(fmt::format("{}: no such file; expected {}", path.string(), kFormats));
  }
  RecordInput(path);
  if (!IsVideo(ImageBytes::OfFile(path).UpTo(0, kSignatureSize))) {
    const std::string kind = KindOfFile(path);
    throw InputError(fmt::format("{}: is {}; expected {}", path.string(),
                                 kind.empty() ? "no video that can be read" : kind, kFormats));
  }
  av_log_set_level(AV_LOG_QUIET);  // its messages do not name the file
  AVDictionary* limits = nullptr;
  av_dict_set(&limits, "protocol_whitelist", "file", 0);
  av_dict_set(&limits, "format_whitelist", "mov,avi,matroska", 0);
  // Without the protocol, names with a colon are taken for addresses.
  AVFormatContext*& format = decoder_->format;
  const int error =
      avformat_open_input(&format, ("file:" + path.string()).c_str(), nullptr, &limits);
  av_dict_free(&limits);
  const bool has_streams = error >= 0 && avformat_find_stream_info(format, nullptr) >= 0;
  const auto area = [](const AVStream& video) {
    return std::int64_t{video.codecpar->width} * video.codecpar->height;
  };
  AVStream* stream = nullptr;  // with the largest frames, the first among equals
  for (unsigned i = 0; has_streams && i < format->nb_streams; ++i) {
    AVStream* other = format->streams[i];
    if (IsOfFrames(*other) && (stream == nullptr || area(*other) > area(*stream))) stream = other;
  }
  const AVCodec* codec =
      stream == nullptr ? nullptr : avcodec_find_decoder(stream->codecpar->codec_id);
  if (stream != nullptr && codec == nullptr) {
    char tag[AV_FOURCC_MAX_STRING_SIZE];
    throw InputError(fmt::format(
        "{}: FFmpeg has no decoder for its codec, {} ({}); expected a common one, such as H.264, "
        "HEVC, VP9 or AV1: export it again as one of these",
        path.string(), avcodec_get_name(stream->codecpar->codec_id),
        av_fourcc_make_string(tag, stream->codecpar->codec_tag)));
  }
  decoder_->stream = stream;
  decoder_->codec = avcodec_alloc_context3(codec);
  decoder_->codec->max_pixels = kMaxPixels;
  decoder_->codec->thread_count = 1;  // with more, marks of damaged frames get lost
  if (stream == nullptr || !IsImageSize(stream->codecpar->width, stream->codecpar->height) ||
      avcodec_parameters_to_context(decoder_->codec, stream->codecpar) < 0 ||
      avcodec_open2(decoder_->codec, codec, nullptr) < 0) {
    throw InputError(fmt::format(
        "{}: cannot be opened; expected {}: is it cut short, or packed in an unusual way? {}",
        path.string(), kFormats, kByFfmpeg));
  }
  if (const std::uint8_t* matrix = DisplayMatrix(*stream)) {
    decoder_->turn = ReadTurn(matrix, path.string());
  }
  const double rate = av_q2d(av_guess_frame_rate(format, stream, nullptr));
  frame_duration_s_ = std::isfinite(rate) && rate > 0.0 ? 1.0 / rate : 1.0 / 30.0;
}

VideoReader::~VideoReader() = default;

// Reads the next packet of the video; false at the end of the file.
bool VideoReader::ReadPacket() {
  AVPacket& packet = *decoder_->packet;
  const AVFormatContext& format = *decoder_->format;
  // MKV announces one duration, that of all streams, subtitles among them.
  const bool all_count = decoder_->stream->duration == AV_NOPTS_VALUE;
  for (av_packet_unref(&packet); av_read_frame(decoder_->format, &packet) >= 0;
       av_packet_unref(&packet)) {
    const AVStream& stream = *format.streams[packet.stream_index];
    if (all_count || IsOfFrames(stream) || stream.codecpar->codec_type == AVMEDIA_TYPE_AUDIO) {
      const std::int64_t stamp = packet.pts == AV_NOPTS_VALUE ? packet.dts : packet.pts;
      if (stamp != AV_NOPTS_VALUE) {
        const auto end = static_cast<double>(stamp + packet.duration);
        end_s_ = std::max(end_s_, end * av_q2d(stream.time_base));
      }
      announced_s_ = std::max(announced_s_, AnnouncedDuration(format, stream));
    }
    const bool is_whole = (packet.flags & AV_PKT_FLAG_CORRUPT) == 0;
    ends_within_packet_ = ends_within_packet_ || !is_whole;
    // An empty packet would end the decoding.
    if (&stream == decoder_->stream && is_whole && packet.size > 0) return true;
  }
  return false;
}

bool VideoReader::Next() {
  constexpr int kMaxFrames = 20'000;
  AVFrame& frame = *decoder_->frame;
  bool is_after_error = is_damaged_;
  const auto note_error = [&](bool is_error) {
    has_errors_ = has_errors_ || is_error;
    is_after_error = is_after_error || is_error;
  };
  int received;
  while ((received = avcodec_receive_frame(decoder_->codec, &frame)) < 0) {
    note_error(received != AVERROR(EAGAIN) && received != AVERROR_EOF);
    if (is_at_end_) return false;
    is_at_end_ = !ReadPacket();
    const AVPacket* packet = is_at_end_ ? nullptr : decoder_->packet;
    note_error(avcodec_send_packet(decoder_->codec, packet) < 0);
  }
  if (++frames_ > kMaxFrames) {
    throw InputError(fmt::format(
        "{}: has more than {} frames; expected a shorter one, or one with fewer frames per second",
        path_.string(), kMaxFrames));
  }
  const bool is_predicted =
      frame.pict_type == AV_PICTURE_TYPE_P || frame.pict_type == AV_PICTURE_TYPE_B;
  is_damaged_ = frame.decode_error_flags != 0 || (frame.flags & AV_FRAME_FLAG_CORRUPT) != 0 ||
                (is_predicted && is_after_error);
  // A matrix of the codec holds until the next one.
  if (const auto* own = av_frame_get_side_data(&frame, AV_FRAME_DATA_DISPLAYMATRIX)) {
    decoder_->turn = ReadTurn(own->data, path_.string());
  }
  const std::int64_t stamp = frame.best_effort_timestamp;
  if (frames_ == 1) first_stamp_ = stamp == AV_NOPTS_VALUE ? 0 : stamp;
  const double time_s =
      static_cast<double>(stamp - first_stamp_) * av_q2d(decoder_->stream->time_base);
  const double next_s = frames_ == 1 ? 0.0 : time_s_ + frame_duration_s_;
  time_s_ = stamp != AV_NOPTS_VALUE && time_s > time_s_ ? time_s : next_s;
  return true;
}

cv::Mat VideoReader::Image(int mode) {
  const bool is_grey = mode == cv::IMREAD_GRAYSCALE;
  const AVFrame& frame = *decoder_->frame;
  const double aspect =
      av_q2d(av_guess_sample_aspect_ratio(decoder_->format, decoder_->stream, decoder_->frame));
  // Pixels become square by more of them along the longer side of a pixel, so that none is lost.
  const double scale_x = aspect > 1.0 ? aspect : 1.0;
  const double scale_y = aspect > 0.0 && aspect < 1.0 ? 1.0 / aspect : 1.0;
  const auto width = std::llround(scale_x * frame.width);
  const auto height = std::llround(scale_y * frame.height);
  if (!IsImageSize(width, height)) {
    throw InputError(
        fmt::format("{}: has frames of {} x {} pixels, each {:.3g} times as wide as high; expected "
                    "a smaller size",
                    path_.string(), frame.width, frame.height, aspect));
  }
  // Values that are equal on every processor.
  constexpr int kExact = SWS_ACCURATE_RND | SWS_BITEXACT;
  decoder_->converter =
      sws_getCachedContext(decoder_->converter, frame.width, frame.height,
                           static_cast<AVPixelFormat>(frame.format), static_cast<int>(width),
                           static_cast<int>(height), is_grey ? AV_PIX_FMT_GRAY8 : AV_PIX_FMT_BGR24,
                           SWS_BICUBIC | kExact, nullptr, nullptr, nullptr);
  if (decoder_->converter != nullptr) {
    constexpr int kOne = 1 << 16;
    sws_setColorspaceDetails(decoder_->converter, sws_getCoefficients(frame.colorspace),
                             frame.color_range == AVCOL_RANGE_JPEG,
                             sws_getCoefficients(SWS_CS_DEFAULT), 1, 0, kOne, kOne);
  }
  av_frame_unref(decoder_->converted);
  if (decoder_->converter == nullptr ||
      sws_scale_frame(decoder_->converter, decoder_->converted, &frame) < 0) {
    throw InputError(
        fmt::format("{}: its format of pixels cannot be converted. {}", path_.string(), kByFfmpeg));
  }
  const cv::Mat stored(static_cast<int>(height), static_cast<int>(width),
                       is_grey ? CV_8UC1 : CV_8UC3, decoder_->converted->data[0],
                       static_cast<size_t>(decoder_->converted->linesize[0]));
  return Turned(stored, decoder_->turn.value_or(ImageTurn{}));
}

int VideoReader::announced_frames() const {
  const double announced_s = AnnouncedDuration(*decoder_->format, *decoder_->stream);
  return static_cast<int>(std::lround(std::min(announced_s / frame_duration_s_, 1e9)));
}

bool VideoReader::is_cut_short() const {
  return ends_within_packet_ || end_s_ < 0.9 * announced_s_;
}

std::string VideoReader::ignored_rotation() const {
  const AVDictionaryEntry* tag = av_dict_get(decoder_->stream->metadata, "rotate", nullptr, 0);
  return tag == nullptr || tag->value == "0"sv || decoder_->turn ? "" : tag->value;
}

}  // namespace soslam

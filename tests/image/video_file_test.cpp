// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/image/video_file.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "support/drawn_photos.h"
#include "support/expect_error.h"
#include "support/run_command.h"
#include "support/video_files.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

std::vector<cv::Mat> DrawnViews(int count) {
  std::vector<cv::Mat> views;
  for (int i = 0; i < count; ++i) views.push_back(DrawnView(10 * i));
  return views;
}

double MeanDifference(const cv::Mat& a, const cv::Mat& b) {
  return cv::norm(a, b, cv::NORM_L1) / static_cast<double>(a.total() * a.channels());
}

// Reads a video to its end; the times of its frames.
std::vector<double> TimesOf(VideoReader* video) {
  std::vector<double> times;
  while (video->Next()) times.push_back(video->time_s());
  return times;
}

TEST(VideoReaderTest, ReadsAllFramesWithTheirTimes) {
  const TemporaryFolder folder;
  for (const char* extension : {"avi", "mov", "mkv"}) {
    const auto path = folder / (std::string("a: video's $name.") + extension);
    WriteVideo(path, {{{DrawnView(0), DrawnView(50), DrawnView(100)}}});
    VideoReader video(path);
    EXPECT_EQ(video.announced_frames(), 3);
    for (int i = 0; i < 3; ++i) {
      ASSERT_TRUE(video.Next()) << i;
      EXPECT_NEAR(video.time_s(), 0.1 * i, 1e-6);
      EXPECT_FALSE(video.is_damaged());
      const cv::Mat image = video.Image(cv::IMREAD_COLOR).clone();
      ASSERT_EQ(image.size(), cv::Size(320, 240));
      EXPECT_LT(MeanDifference(image, DrawnView(50 * i)), 10.0);
      EXPECT_LT(MeanDifference(video.Image(cv::IMREAD_GRAYSCALE), GreyOf(image)), 1.5);
    }
    EXPECT_FALSE(video.Next());
    EXPECT_FALSE(video.is_cut_short());
    EXPECT_FALSE(video.has_errors());
  }
}

TEST(VideoReaderTest, RefusesWhatIsNoVideo) {
  const TemporaryFolder folder;
  const auto path = folder / "video.mp4";
  const auto read = [&] { VideoReader video(path); };
  ExpectError<InputError>(read, {path.string(), "no such file"});
  for (const std::string& bytes :
       {std::string(), std::string("text"), std::string("#EXTM3U\nhttp://example.org/a.ts\n"),
        std::string("RIFF")}) {
    WriteBytes(path, bytes);
    ExpectError<InputError>(read, {path.string(), "is no video", "MP4"});
  }
  WriteBytes(path, std::string("RIFF\0\0\0\0WEBP", 12));
  ExpectError<InputError>(read, {path.string(), "is a WebP image; expected a video: MP4"});
  WriteVideo(folder / "whole.avi", {{DrawnViews(1)}});
  testing::internal::CaptureStderr();
  for (const std::string& bytes : {FileBytes(folder / "whole.avi").substr(0, 100),
                                   std::string("\0\0\0\x18"
                                               "ftypmp42",
                                               12),
                                   std::string("\x1a\x45\xdf\xa3")}) {
    WriteBytes(path, bytes);
    ExpectError<InputError>(read, {path.string(), "cannot be opened", "ffmpeg -i"});
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(VideoReaderTest, NamesACodecWithoutDecoder) {
  const TemporaryFolder folder;
  WriteVideo(folder / "video.mov", {{DrawnViews(2)}});
  std::string bytes = FileBytes(folder / "video.mov");
  bytes.replace(bytes.find("jpeg", bytes.find("stsd")), 4, "new7");
  WriteBytes(folder / "video.mov", bytes);
  ExpectError<InputError>([&] { VideoReader video(folder / "video.mov"); },
                          {"video.mov", "no decoder", "new7", "H.264"});
}

TEST(VideoReaderTest, RefusesFramesOfAbsurdSizeBeforeDecoding) {
  const TemporaryFolder folder;
  const auto path = folder / "video.mov";
  WriteVideo(path, {{DrawnViews(1)}});
  const auto width_and_height = [](std::uint64_t width, std::uint64_t height) {
    return NumberBytes(width, 2, ByteOrder::kBigEndian) +
           NumberBytes(height, 2, ByteOrder::kBigEndian);
  };
  std::string bytes = FileBytes(path);
  const size_t description = bytes.find("stsd");
  bytes.replace(bytes.find(width_and_height(320, 240), description), 4,
                width_and_height(12'000, 12'000));
  bytes.replace(bytes.find("jpeg", description), 4, "raw ");  // a codec whose size is that of MOV
  WriteBytes(path, bytes);
  ExpectError<InputError>([&] { VideoReader video(path); }, {path.string(), "cannot be opened"});
}

TEST(VideoReaderTest, FramesAreTurnedAsTheDisplayMatrixSays) {
  const TemporaryFolder folder;
  const auto path = folder / "video.mp4";
  // A quadrant of each brightness, which is found where the matrix maps it to.
  const auto quadrant = [](const cv::Size& size, double x, double y) {
    const cv::Size half = size / 2;
    return cv::Rect({x > 0.0 ? half.width : 0, y > 0.0 ? half.height : 0}, half);
  };
  const auto brightness = [](double x, double y) { return 120.0 + 40.0 * x + 80.0 * y; };
  const cv::Size size = {64, 32};
  cv::Mat stored(size, CV_8UC3);
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      stored(quadrant(size, x, y)).setTo(cv::Scalar::all(brightness(x, y)));
    }
  }
  WriteVideo(path, {{{stored, stored}}});
  const std::string plain = FileBytes(path);
  for (const double a : {-1.0, 1.0}) {
    for (const double b : {-1.0, 1.0}) {
      for (const DisplayAxes axes : {DisplayAxes{a, 0.0, 0.0, b}, DisplayAxes{0.0, a, b, 0.0}}) {
        SCOPED_TRACE(testing::Message() << axes.x_x << axes.x_y << axes.y_x << axes.y_y);
        WriteBytes(path,
                   axes.x_x == 1.0 && axes.y_y == 1.0 ? plain : WithDisplayMatrix(plain, axes));
        VideoReader video(path);
        ASSERT_TRUE(video.Next());
        const cv::Mat image = video.Image(cv::IMREAD_GRAYSCALE);
        ASSERT_EQ(image.size(), axes.x_x == 0.0 ? cv::Size(32, 64) : size);
        for (const double x : {-1.0, 1.0}) {
          for (const double y : {-1.0, 1.0}) {
            const auto shown =
                quadrant(image.size(), axes.x_x * x + axes.y_x * y, axes.x_y * x + axes.y_y * y);
            EXPECT_NEAR(cv::mean(image(shown))[0], brightness(x, y), 3.0);
          }
        }
      }
    }
  }
  WriteBytes(path, WithDisplayMatrix(plain, {0.9999, 0.01, -0.01, 0.9999}));
  EXPECT_TRUE(VideoReader(path).Next()) << "half a degree";
  WriteBytes(path, WithDisplayMatrix(plain, {0.866, 0.5, -0.5, 0.866}));
  ExpectError<InputError>([&] { VideoReader video(path); }, {path.string(), "30 degrees", "90"});
}

TEST(VideoReaderTest, PixelsBecomeSquareWithoutLossOfResolution) {
  const TemporaryFolder folder;
  for (const char* name : {"video.mov", "video.mkv"}) {
    WriteVideo(folder / name, {{DrawnViews(1), {}, {4, 3}}});
    VideoReader wide(folder / name);
    ASSERT_TRUE(wide.Next());
    cv::Mat expected;
    cv::resize(DrawnView(0), expected, {427, 240}, 0.0, 0.0, cv::INTER_CUBIC);
    const cv::Mat image = wide.Image(cv::IMREAD_COLOR);
    ASSERT_EQ(image.size(), expected.size());
    EXPECT_LT(MeanDifference(image, expected), 10.0);
    WriteVideo(folder / name, {{DrawnViews(1), {}, {3, 4}}});
    VideoReader high(folder / name);
    ASSERT_TRUE(high.Next());
    EXPECT_EQ(high.Image(cv::IMREAD_COLOR).size(), cv::Size(320, 320));
  }
  WriteVideo(folder / "thin.mkv", {{DrawnViews(1), {}, {1, 100'000}}});
  VideoReader thin(folder / "thin.mkv");
  ASSERT_TRUE(thin.Next());
  ExpectError<InputError>([&] { thin.Image(cv::IMREAD_COLOR); }, {"thin.mkv", "320 x 240"});
}

TEST(VideoReaderTest, ReadsTheStreamWithTheLargestFrames) {
  const TemporaryFolder folder;
  const cv::Mat small(120, 160, CV_8UC3, cv::Scalar::all(200));
  const cv::Mat black(240, 320, CV_8UC3, cv::Scalar::all(0));
  for (const char* name : {"video.mov", "video.mkv", "video.avi"}) {
    WriteVideo(folder / name, {{{small, small}}, {DrawnViews(2)}, {{black, black}}});
    VideoReader video(folder / name);
    ASSERT_TRUE(video.Next());
    const cv::Mat image = video.Image(cv::IMREAD_COLOR);
    ASSERT_EQ(image.size(), cv::Size(320, 240));
    EXPECT_LT(MeanDifference(image, DrawnView(0)), 10.0) << "the first of equals";
  }
}

TEST(VideoReaderTest, FramesBeforeAnEditListAreNoneThatAreMissing) {
  const TemporaryFolder folder;
  const auto path = folder / "trimmed.mov";
  WriteVideo(path, {{DrawnViews(8), {-5, -4, -3, -2, -1, 0, 1, 2}}});
  VideoReader video(path);
  EXPECT_EQ(video.announced_frames(), 3);
  ASSERT_TRUE(video.Next());
  EXPECT_LT(MeanDifference(video.Image(cv::IMREAD_COLOR), DrawnView(50)), 10.0);
  EXPECT_EQ(TimesOf(&video).size(), 2u);
  EXPECT_FALSE(video.is_cut_short());
}

TEST(VideoReaderTest, FramesMayHaveAnyDistanceInTime) {
  const TemporaryFolder folder;
  for (const char* name : {"video.mov", "video.mkv"}) {
    WriteVideo(folder / name, {{DrawnViews(5), {3, 4, 17, 18, 60}}});
    VideoReader video(folder / name);
    EXPECT_THAT(TimesOf(&video),
                testing::Pointwise(testing::DoubleNear(1e-6), {0.0, 0.1, 1.4, 1.5, 5.7}));
    EXPECT_FALSE(video.is_cut_short());
  }
}

TEST(VideoReaderTest, VideosThatAreCutShortAreNoticed) {
  const TemporaryFolder folder;
  for (const std::string name : {"video.mov", "video.mkv", "video.avi"}) {
    WriteVideo(folder / name, {{DrawnViews(20)}});
    const std::string whole = FileBytes(folder / name);
    for (const double share : {0.5, 0.8}) {
      WriteBytes(folder / name,
                 whole.substr(0, static_cast<size_t>(share * static_cast<double>(whole.size()))));
      VideoReader video(folder / name);
      const auto frames = static_cast<double>(TimesOf(&video).size());
      EXPECT_NEAR(frames, 20.0 * share, 1.0);
      EXPECT_TRUE(video.is_cut_short()) << name << " " << share;
    }
  }
}

// Chapters are a track of their own, which ends with the last of them.
TEST(VideoReaderTest, PicturesAndSoundSayHowLongAVideoIs) {
  const TemporaryFolder folder;
  const auto path = folder / "video.mov";
  WriteVideo(path, {{DrawnViews(3)}});
  std::string bytes = FileBytes(path);
  const size_t duration = bytes.find("mvhd") + 20;  // of the longest track
  bytes.replace(duration, 4, NumberBytes(900'000, 4, ByteOrder::kBigEndian));
  VideoReader video(WriteBytes(path, bytes));
  EXPECT_EQ(video.announced_frames(), 3);
  EXPECT_EQ(TimesOf(&video).size(), 3u);
  EXPECT_FALSE(video.is_cut_short());
}

TEST(VideoReaderTest, ATagThatPlayersIgnoreIsTold) {
  const TemporaryFolder folder;
  const auto tag_in = [&](const std::string& name, const std::string& tag) {
    WriteVideo(folder / name, {{DrawnViews(1), {}, {1, 1}, tag}});
    return VideoReader(folder / name).ignored_rotation();
  };
  EXPECT_EQ(tag_in("video.mkv", "90"), "90");
  EXPECT_EQ(tag_in("video.mkv", "0"), "");
  EXPECT_EQ(tag_in("video.mkv", ""), "");
}

// Videos that the program ffmpeg makes, and shows in its own way.
class SlowVideoTest : public testing::Test {
 protected:
  void SetUp() override {
    if (RunCommand({"which", "ffmpeg"}).exit_code != 0) GTEST_SKIP() << "there is no ffmpeg";
  }

  // Runs ffmpeg with arguments that are separated by blanks; {} is a test picture of 3 s.
  void Ffmpeg(const std::string& arguments, const fs::path& output) const {
    std::vector<std::string> words = {"ffmpeg", "-v", "error", "-y"};
    std::istringstream stream(arguments);
    for (std::string word; stream >> word;) {
      if (word == "{}") {
        words.insert(words.end(), {"-f", "lavfi", "-i", "testsrc2=s=320x240:r=10:d=3"});
      } else {
        words.push_back(word.starts_with("/") ? (folder_ / word.substr(1)).string() : word);
      }
    }
    words.push_back(output.string());
    ExpectSuccess(RunCommand(words));
  }

  // Expects that the reader shows the frames of the video, `count` of this size, as ffmpeg does, up
  // to a mean difference of grey values.
  void ExpectSameAsFfmpeg(const fs::path& path, const cv::Size& size, int count,
                          double limit = 1.0) const {
    SCOPED_TRACE(path.filename());
    Ffmpeg("-i /" + path.filename().string() +
               " -fps_mode passthrough -vf "
               "scale=trunc(iw*max(1\\,sar)+0.5):trunc(ih*max(1\\,1/"
               "sar)+0.5):flags=bicubic+accurate_rnd+bitexact -pix_fmt bgr24 -f "
               "rawvideo",
           folder_ / "frames");
    std::string expected = FileBytes(folder_ / "frames");
    ASSERT_EQ(expected.size(), static_cast<size_t>(count) * 3 * size.area());
    VideoReader video(path);
    for (int i = 0; i < count; ++i) {
      ASSERT_TRUE(video.Next()) << i;
      EXPECT_FALSE(video.is_damaged()) << i;
      const cv::Mat image = video.Image(cv::IMREAD_COLOR);
      ASSERT_EQ(image.size(), size);
      const cv::Mat shown(size, CV_8UC3,
                          expected.data() + static_cast<size_t>(i) * 3 * size.area());
      EXPECT_LT(MeanDifference(image, shown), limit) << i;
    }
    EXPECT_FALSE(video.Next());
    EXPECT_FALSE(video.is_cut_short());
    EXPECT_FALSE(video.has_errors());
  }

  static constexpr const char* kH264 = " -c:v libx264 -crf 10 -bf 2 -g 10 -pix_fmt yuv420p ";

  // ffmpeg turns frames before it interpolates their colours, which have half the resolution.
  static constexpr double kTurnedFirst = 4.0;

  TemporaryFolder folder_;
};

TEST_F(SlowVideoTest, FramesAreTurnedAsFfmpegTurnsThem) {
  Ffmpeg(std::string("{}") + kH264, folder_ / "plain.mp4");
  const std::string plain = FileBytes(folder_ / "plain.mp4");
  ExpectSameAsFfmpeg(folder_ / "plain.mp4", {320, 240}, 30);
  for (const DisplayAxes axes :
       {DisplayAxes{0, 1, -1, 0}, DisplayAxes{-1, 0, 0, -1}, DisplayAxes{0, -1, 1, 0},
        DisplayAxes{-1, 0, 0, 1}, DisplayAxes{1, 0, 0, -1}, DisplayAxes{0, 1, 1, 0},
        DisplayAxes{0, -1, -1, 0}}) {
    const auto path = WriteBytes(folder_ / "turned.mp4", WithDisplayMatrix(plain, axes));
    ExpectSameAsFfmpeg(path, axes.x_x == 0.0 ? cv::Size(240, 320) : cv::Size(320, 240), 30,
                       kTurnedFirst);
  }
  Ffmpeg(
      "-i /plain.mp4 -c copy -frames:v 1 -bsf:v h264_metadata=display_orientation=insert:rotate=90",
      folder_ / "codec.mp4");
  ExpectSameAsFfmpeg(folder_ / "codec.mp4", {240, 320}, 1, kTurnedFirst);
}

TEST_F(SlowVideoTest, PixelsAreMadeSquareAsFfmpegMakesThem) {
  for (const char* name : {"pixels.mp4", "pixels.mkv", "pixels.mov"}) {
    Ffmpeg(std::string("{} -vf setsar=4/3") + kH264, folder_ / name);
    ExpectSameAsFfmpeg(folder_ / name, {427, 240}, 30);
    Ffmpeg(std::string("{} -vf setsar=2/3") + kH264, folder_ / name);
    ExpectSameAsFfmpeg(folder_ / name, {320, 360}, 30);
  }
  const std::string upright = FileBytes(folder_ / "pixels.mp4");
  WriteBytes(folder_ / "turned.mp4", WithDisplayMatrix(upright, {0, 1, -1, 0}));
  ExpectSameAsFfmpeg(folder_ / "turned.mp4", {360, 320}, 30, kTurnedFirst);
}

TEST_F(SlowVideoTest, ColoursAreThoseOfFfmpeg) {
  const std::vector<std::pair<std::string, std::string>> kinds = {
      {"601.mp4", "-colorspace smpte170m -c:v libx264 -crf 10 -pix_fmt yuv420p"},
      {"709.mp4",
       "-vf scale=out_color_matrix=bt709 -colorspace bt709 -c:v libx264 -crf 10 -pix_fmt yuv420p"},
      {"full.mp4",
       "-vf scale=out_color_matrix=bt709:out_range=full -colorspace bt709 "
       "-color_range pc -c:v libx264 -crf 10 -pix_fmt yuv420p"},
      {"jpeg.mp4", "-vf format=yuvj420p -c:v libx264 -crf 10"},
      {"hdr.mp4",
       "-vf scale=out_color_matrix=bt2020 -colorspace bt2020nc -color_primaries bt2020 "
       "-color_trc smpte2084 -c:v libx265 -x265-params log-level=none -crf 10 -pix_fmt "
       "yuv420p10le"},
      {"444.mkv", "-c:v libx264 -crf 10 -pix_fmt yuv444p10le"},
      {"grey.mp4", "-c:v libx264 -crf 10 -pix_fmt gray"},
      {"rgb.mkv", "-c:v ffv1 -pix_fmt bgr0"},
      {"alpha.mov", "-c:v prores_ks -profile:v 4444 -pix_fmt yuva444p10le"},
      {"alpha.webm", "-vf format=yuva420p -c:v libvpx-vp9 -b:v 1M"},
      {"invisible.webm", "-c:v libvpx -auto-alt-ref 1 -lag-in-frames 16 -b:v 1M"},
      {"jpeg.avi", "-c:v mjpeg -q:v 2"},
      {"divx.avi", "-c:v mpeg4 -bf 2 -q:v 2"},
      {"interlaced.mp4", "-c:v libx264 -crf 10 -flags +ilme+ildct -pix_fmt yuv420p"}};
  for (const auto& [name, arguments] : kinds) {
    Ffmpeg("{} " + arguments, folder_ / name);
    ExpectSameAsFfmpeg(folder_ / name, {320, 240}, 30);
  }
}

TEST_F(SlowVideoTest, WholeVideosAreNotTakenForCutOnes) {
  Ffmpeg(std::string("{}") + kH264, folder_ / "whole.mp4");
  // Trimmed: packets before the edit list are for decoding only.
  Ffmpeg("-ss 1.45 -i /whole.mp4 -c copy", folder_ / "begin.mp4");
  ExpectSameAsFfmpeg(folder_ / "begin.mp4", {320, 240}, 15);
  Ffmpeg("-ss 1.45 -i /whole.mp4 -t 0.5 -c copy", folder_ / "middle.mov");
  VideoReader middle(folder_ / "middle.mov");
  EXPECT_LT(TimesOf(&middle).size(), 10u);
  EXPECT_FALSE(middle.is_cut_short());
  Ffmpeg("-itsoffset 2 -i /whole.mp4 -c copy", folder_ / "delayed.mp4");
  ExpectSameAsFfmpeg(folder_ / "delayed.mp4", {320, 240}, 30);
  // Frames at irregular times, sound that lasts longer, and fragments.
  for (const char* name : {"frames.mp4", "frames.mkv"}) {
    Ffmpeg(std::string("{} -vf select='lt(n\\,9)+not(mod(n\\,7))' -fps_mode vfr") + kH264,
           folder_ / name);
    ExpectSameAsFfmpeg(folder_ / name, {320, 240}, 12);
  }
  for (const char* name : {"sound.mp4", "sound.mkv", "sound.avi"}) {
    Ffmpeg(std::string("{} -f lavfi -i sine=d=9 -c:a mp2") + kH264, folder_ / name);
    ExpectSameAsFfmpeg(folder_ / name, {320, 240}, 30);
  }
  Ffmpeg("-i /whole.mp4 -c copy -movflags frag_keyframe+empty_moov", folder_ / "fragments.mp4");
  ExpectSameAsFfmpeg(folder_ / "fragments.mp4", {320, 240}, 30);
  // Chapters and subtitles that end later.
  const std::string chapter = "[CHAPTER]\nTIMEBASE=1/1\n";
  WriteBytes(folder_ / "chapters.txt", ";FFMETADATA1\n" + chapter + "START=0\nEND=1\ntitle=one\n" +
                                           chapter + "START=1\nEND=90\ntitle=two\n");
  WriteBytes(folder_ / "words.srt", "1\n00:00:01,000 --> 00:01:30,000\nwords\n");
  for (const char* name : {"chapters.mp4", "chapters.mov", "chapters.mkv"}) {
    Ffmpeg("-i /whole.mp4 -i /chapters.txt -map_chapters 1 -c copy", folder_ / name);
    ExpectSameAsFfmpeg(folder_ / name, {320, 240}, 30);
  }
  for (const char* name : {"words.mp4", "words.mkv"}) {
    const std::string codec = name == std::string("words.mp4") ? "mov_text" : "srt";
    Ffmpeg("-i /whole.mp4 -i /words.srt -map 0 -map 1 -c copy -c:s " + codec, folder_ / name);
    ExpectSameAsFfmpeg(folder_ / name, {320, 240}, 30);
  }
  // A larger cover is no video.
  Ffmpeg("-f lavfi -i testsrc=s=800x600 -frames:v 1", folder_ / "cover.png");
  Ffmpeg("-i /whole.mp4 -i /cover.png -map 0 -map 1 -c copy -disposition:v:1 attached_pic",
         folder_ / "cover.mp4");
  ExpectSameAsFfmpeg(folder_ / "cover.mp4", {320, 240}, 30);
}

TEST_F(SlowVideoTest, CutAndDamagedVideosAreNoticed) {
  Ffmpeg(std::string("{}") + kH264 + "-movflags faststart", folder_ / "whole.mp4");
  const std::string whole = FileBytes(folder_ / "whole.mp4");
  const auto path = WriteBytes(folder_ / "cut.mp4", whole.substr(0, whole.size() - 1000));
  VideoReader cut(path);
  EXPECT_GT(TimesOf(&cut).size(), 20u);
  EXPECT_TRUE(cut.is_cut_short());
  // A damaged frame spoils those that are predicted from it, up to the next key frame.
  std::string bytes = whole;
  bytes.replace(bytes.size() / 2, 300, std::string(300, '\x55'));
  VideoReader damaged(WriteBytes(path, bytes));
  int damaged_frames = 0, frames = 0;
  for (; damaged.Next(); ++frames) damaged_frames += damaged.is_damaged() ? 1 : 0;
  EXPECT_GT(frames, 20);
  EXPECT_GT(damaged_frames, 0);
  EXPECT_LE(damaged_frames, 10);
  EXPECT_FALSE(damaged.is_cut_short());
}

}  // namespace
}  // namespace soslam

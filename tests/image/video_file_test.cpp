// SPDX-License-Identifier: BSD-3-Clause
#include "image/video_file.h"

#include <gtest/gtest.h>

#include "support/drawn_photos.h"
#include "support/expect_error.h"

namespace soslam {
namespace {

TEST(VideoReaderTest, ReadsAllFramesWithTheirTimes) {
  const TemporaryFolder folder;
  const auto path = folder / "a: video's $name.avi";
  WriteVideo(path, {DrawnView(0), DrawnView(50), DrawnView(100)});
  VideoReader video(path);
  EXPECT_EQ(video.announced_frames(), 3);
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(video.Next()) << i;
    EXPECT_NEAR(video.time_s(), 0.1 * i, 1e-6);
    ASSERT_EQ(video.image().size(), cv::Size(320, 240));
    EXPECT_LT(cv::norm(video.image(), DrawnView(50 * i), cv::NORM_L1) / (3 * 320 * 240), 10.0);
  }
  EXPECT_FALSE(video.Next());
}

TEST(VideoReaderTest, RefusesWhatIsNoVideo) {
  const TemporaryFolder folder;
  const auto path = folder / "video.mp4";
  const auto read = [&] { VideoReader video(path); };
  ExpectError<InputError>(read, {path.string(), "no such file"});
  for (const std::string& bytes :
       {std::string(), std::string("text"), std::string("#EXTM3U\nhttp://example.org/a.ts\n"),
        std::string("RIFF"), std::string("RIFF\0\0\0\0WEBP", 12)}) {
    WriteBytes(path, bytes);
    ExpectError<InputError>(read, {path.string(), "is no video", "MP4"});
  }
  WriteVideo(folder / "whole.avi", {DrawnView(0)});
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

}  // namespace
}  // namespace soslam

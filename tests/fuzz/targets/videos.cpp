// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz/fuzz_target.h"
#include "image/video_file.h"

namespace soslam {
namespace {

const FuzzTarget kVideos("videos", [](const HostileInput& input) {
  constexpr int kMaxFrames = 20;
  const auto file = input.AsFile("video.avi");
  IsAccepted(file, [&] {
    VideoReader video(file);
    for (int i = 0; i < kMaxFrames && video.Next(); ++i) {
    }
  });
});

}  // namespace
}  // namespace soslam

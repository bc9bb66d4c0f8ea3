// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <opencv2/core/types.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "artefact/frames_file.h"
#include "model/finding.h"

namespace soslam {

// Frames with what they were chosen from.
struct ChosenFrames {
  FramesRecord record;
  cv::Size source_size;  // of the images that were chosen from, upright
  std::vector<std::filesystem::path> inputs;
  bool is_cut_short = false;  // the video has fewer frames than it announces
};

inline bool IsLeftOut(const SourceFrame& frame) { return frame.rejection.has_value(); }

// Number of frames that were left out, by reason.
std::map<std::string, int> CountLeftOut(const std::vector<SourceFrame>& frames);

// Finds more than a third of the images left out for one reason, and a video that was cut short.
std::vector<Finding> CheckFrames(const ChosenFrames& chosen);

// The text of rgb.txt. Times are those of the video; photos are numbered.
std::string FrameListText(const std::vector<SourceFrame>& frames);

// First line of detections.csv.
inline constexpr std::string_view kFrameBoxesMark = "# Written by soslam-frames";

// The text of detections.csv: the boxes of the chosen images among those of all images in the file
// `path`. Prints how many they are. Throws InputError if there are none.
std::string FrameBoxesText(const std::filesystem::path& path, const ChosenFrames& chosen);

}  // namespace soslam

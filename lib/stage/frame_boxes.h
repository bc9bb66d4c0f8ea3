// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "stage/choose_frames.h"

namespace soslam {

// Begin of the first line of the detections.csv that soslam-frames writes, by which a later run
// recognises it.
inline constexpr std::string_view kFrameBoxesMark = "# Written by soslam-frames";

// The text of detections.csv: the boxes of the chosen images among those of all images in the file
// `path`. Prints how many they are. Throws InputError as ReadDetectionsCsv, when there are none,
// and for a file of other images.
std::string FrameBoxesText(const std::filesystem::path& path, const ChosenFrames& chosen);

}  // namespace soslam

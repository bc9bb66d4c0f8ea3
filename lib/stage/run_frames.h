// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/stage_files.h"
#include "image/frame_choice.h"

namespace soslam {

// soslam-frames: chooses frames from "images", a folder of photos or a video, and writes the
// dataset folder "output": rgb/, rgb.txt, frames.json and README.md. With "detections", a
// detections.csv for all images, the folder also has that of the chosen ones. Prints how many are
// chosen, and how many are left out for which reason. Throws InputError for a bad folder or video,
// or boxes of none of the images, SettingsError for a folder that must not be replaced, and
// NothingUsableError if fewer than two frames remain.
void RunFrames(const FrameOptions& options, const StageFiles& files, int threads);

}  // namespace soslam

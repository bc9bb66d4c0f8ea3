// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "cli/stage_files.h"
#include "model/sequence.h"
#include "planes/up_prior.h"

namespace soslam {

// Line segments of at least `min_length_px` in the images of folder "dataset", per frame; none if
// no frame has an image. The images are added to `inputs`. Throws SettingsError without a folder.
std::vector<SegmentView> ViewsOfSegments(const Sequence& sequence, double min_length_px,
                                         const StageFiles& files, int threads,
                                         std::vector<std::filesystem::path>* inputs);

// Throws InputError, naming the file, if there are several segments: every segment has its own
// world, up direction and planes.
void CheckOneSegment(const Sequence& sequence, const std::filesystem::path& path);

// Sets the scene axes of a sequence's planes from images of the dataset folder, if the sequence has
// one world. Images that are missing or damaged are left out. Those read are added to `inputs`.
void AddSceneAxes(const std::filesystem::path& folder, int threads, Sequence* sequence,
                  std::vector<std::filesystem::path>* inputs);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "dataset/colmap_model.h"
#include "dataset/trajectories.h"
#include "model/finding.h"

namespace soslam {

// Throws InputError unless a finished model is of the images as they are stored, as COLMAP reads
// them: by the size of its camera and, for images that EXIF turns within their size, by the colours
// of its points. It is a finding if these do not tell.
std::vector<Finding> CheckModelOrientation(const ColmapModel& model,
                                           const std::vector<ListedImage>& images,
                                           const std::filesystem::path& dataset);

}  // namespace soslam

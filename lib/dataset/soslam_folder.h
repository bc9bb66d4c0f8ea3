// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "dataset/dataset_content.h"
#include "dataset/import_options.h"

namespace soslam {

// Reads a folder of the project's own format: rgb.txt, odometry.txt and groundtruth.txt (at least
// one of the two; TUM RGB-D format), camera.json, planes.json, detections.csv and, optionally,
// objects.json. Ground truth, when present, fills what the sequence has for evaluation. Throws
// InputError.
DatasetContent ReadSoslamFolder(const std::filesystem::path& folder, const ImportOptions& options);

}  // namespace soslam

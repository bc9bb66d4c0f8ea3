// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "dataset/import_options.h"
#include "model/sequence.h"

namespace soslam {

// Reads a dataset folder, checks everything in it and drops the detections that the protocol of the
// paper's experiments does not use, each with a counted reason.
//
// The folder holds rgb.txt, odometry.txt and groundtruth.txt (at least one of the two; TUM RGB-D
// format), camera.json, planes.json, detections.csv and, optionally, objects.json. Ground truth,
// when present, fills what the sequence has for evaluation. Frames without a pose estimate are left
// out.
//
// Throws InputError, naming file and line or field, for whatever is missing, malformed or
// contradictory; NothingUsableError when no detection is left.
Sequence ImportDataset(const std::filesystem::path& folder, const ImportOptions& options);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "cli/stage_files.h"
#include "image/detector_options.h"

namespace soslam {

// The classes of a network as the options rename, select and group them, from class 0 on.
struct DetectorLabels {
  std::vector<std::string> names;
  std::vector<bool> are_kept;
  std::vector<int> groups;  // classes of one group count as one for max_overlap
};

// Applies rename_labels, keep_labels, interchangeable_labels and class_agnostic to the names of the
// network's classes. Throws SettingsError for malformed options and for labels that no class has.
DetectorLabels LabelsForDetector(std::vector<std::string> classes, const DetectorOptions& options);

// soslam-detect: runs a YOLO network on every image of a dataset. Files: "dataset", the folder with
// rgb.txt; "network", ONNX; "labels" (optional), the names of its classes, one per line: without
// it those in the network's file, or COCO's; "output", a detections.csv without object ids, with
// its provenance as comments above the header. Prints the format that the network was found to
// have, and a one-line summary. Throws InputError for a bad list, image, network or label file, and
// for a network whose boxes cannot be; NothingUsableError when nothing was detected.
void RunDetect(const DetectorOptions& options, const StageFiles& files, int threads);

}  // namespace soslam

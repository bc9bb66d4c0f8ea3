// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/stage_files.h"
#include "image/yolo_detector.h"

namespace soslam {

// soslam-detect: runs a YOLO network on every image of a dataset. Files: "dataset", the folder with
// rgb.txt; "network", ONNX; "labels" (optional; COCO's when absent), the names of its classes, one
// per line; "output", a detections.csv without object ids, with its provenance as comments above
// the header. Prints a one-line summary. Throws InputError for a bad list, image, network or label
// file; NothingUsableError when nothing was detected.
void RunDetect(const DetectorOptions& options, const StageFiles& files, int threads);

}  // namespace soslam

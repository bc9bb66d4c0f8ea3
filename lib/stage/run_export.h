// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/options.h"
#include "cli/stage_files.h"

namespace soslam {

struct ExportOptions {
  bool truth = false;
  bool aligned = false;

  void Describe(OptionVisitor& visit) {
    visit.Group("Objects");
    visit.Flag("truth", &truth,
               "Export the ground truth of the sequence, poses and objects, in place of a map");
    visit.Flag("aligned", &aligned,
               "Write the map where its evaluation moves it, into the world of the ground truth");
  }
};

// soslam-export: writes "sequence" and, unless truth is set, "map" (with its evaluation "metrics")
// to one or more of "trajectory", "ply", "gltf", "coco", "coco_dataset" and "csv". Without a map,
// only the sequence's own poses are exported. With several segments, each in its own world,
// "trajectory", "ply" and "gltf" become one file per segment, map-3.ply. Throws SettingsError
// without an output, for objects without a map or truth, for both, and for an extension that glTF
// does not have; NothingUsableError when there is no pose or landmark to write. Nothing is written
// in these cases.
void RunExport(const ExportOptions& options, const StageFiles& files, int threads);

}  // namespace soslam

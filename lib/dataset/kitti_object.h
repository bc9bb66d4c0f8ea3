// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "dataset/dataset_content.h"
#include "dataset/import_options.h"
#include "dataset/labelled_box.h"
#include "geometry/box.h"

namespace soslam {

// Reads 2D detections of a KITTI sequence as trackers exchange them: <class>/<sequence>.txt, lines
// "frame,x1,y1,x2,y2,score", frames counted from 0, pixels as in KITTI's labels. The label is the
// name of the file's folder, unchanged ("Car"). In file order; a file may have no boxes. Throws
// InputError naming the line.
std::vector<LabelledBox> ReadKittiBoxes(const std::filesystem::path& path);

struct ScoredBox {
  Box box;
  double score = 0.0;
};

// For each found box the index of its given box, if any. One to one and greedy: found boxes in
// order of descending score take the free given box with the largest overlap of at least
// `min_overlap`.
std::vector<std::optional<size_t>> MatchBoxes(const std::vector<ScoredBox>& found,
                                              const std::vector<Box>& given, double min_overlap);

// Reads the object benchmark of KITTI: label_2/NNNNNN.txt, calib/NNNNNN.txt (P2) and, if present,
// image_2/NNNNNN.png. Frames are independent views, so each is its own segment with the camera's
// frame as its world. A frame's id is its number; an object's id is 1000 times that plus the index
// of its label. Each object has its own support plane with the object's id: the bottom face of its
// labelled box. Throws InputError, SettingsError.
DatasetContent ReadKittiObject(const std::filesystem::path& folder, const ImportOptions& options);

}  // namespace soslam

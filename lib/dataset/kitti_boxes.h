// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "dataset/labelled_box.h"

namespace soslam {

// Reads 2D detections of a KITTI sequence as trackers exchange them: <class>/<sequence>.txt, lines
// "frame,x1,y1,x2,y2,score", frames counted from 0, pixels as in KITTI's labels. The label is the
// name of the file's folder, unchanged ("Car"). In file order; a file may have no boxes. Throws
// InputError naming the line.
std::vector<LabelledBox> ReadKittiBoxes(const std::filesystem::path& path);

}  // namespace soslam

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dataset/detection_row.h"
#include "dataset/labelled_box.h"

namespace soslam {

// detections.csv, a table whose first line names the columns, in any order: frame, object_id,
// label, score, x1, y1, x2, y2; others are ignored. Without association the column object_id is
// absent. No quoting: a label cannot hold a comma. The readers throw InputError naming the line,
// and for a file without header.

// Whether the table says which object each box is of.
bool HasObjectIds(const std::filesystem::path& path);

// The rows of a table that says which object each box is of.
std::vector<DetectionRow> ReadDetections(const std::filesystem::path& path);

// The rows of a table with or without object ids, without them. Their frames are rows of rgb.txt.
std::vector<LabelledBox> ReadLabelledBoxes(const std::filesystem::path& path);

// The text of a table without object ids, pixels to two digits, scores to four. The frames have to
// be rows of rgb.txt, the labels without comma.
std::string LabelledBoxesText(const std::vector<LabelledBox>& boxes);

}  // namespace soslam

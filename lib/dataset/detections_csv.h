// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dataset/labelled_box.h"

namespace soslam {

// The rows of detections.csv, a table whose first line names the columns, in any order: frame,
// object_id, label, score, x1, y1, x2, y2; others are ignored. Capitals do not count in these
// names, and blanks are underscores. Fields may be quoted (SplitCsvLine), and have semicolons or
// tabs between them where the header has. Frames are rows of rgb.txt.
//
// Without association the column object_id is absent; a box whose field is empty has none. Throws
// InputError naming the line, and for a file without header.
std::vector<LabelledBox> ReadDetectionsCsv(const std::filesystem::path& path);

// The text of a table without object ids, pixels to two digits, scores to four. The frames have to
// be rows of rgb.txt, the labels without comma.
std::string LabelledBoxesText(const std::vector<LabelledBox>& boxes);

}  // namespace soslam
